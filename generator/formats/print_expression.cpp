#include "generator/formats/print_expression.hpp"

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

enum Level { level_sum = 1, level_product = 2, level_unary = 3 };

std::string bracket(std::string text, int level, int context) {
  return level < context ? "(" + text + ")" : text;
}

}  // namespace

std::string ExpressionPrinter::operator()(const Expression& e) const {
  return print(arrange(e), level_sum);
}

std::string ExpressionPrinter::call(const std::string& function,
                                    const std::string& arguments) const {
  if (is_rounding_error(function)) return dialect_.block(function) + "(" + arguments + ")";
  const std::string name = lanes_ ? dialect_.lane_function(function) : dialect_.function(function);
  if (!name.starts_with("lane_")) functions_.insert(function);
  return name + "(" + arguments + ")";
}

std::string ExpressionPrinter::print(const Arithmetic& a, int context) const {
  const auto operand = [&](std::size_t i, int level) { return print(a.operands[i], level); };
  switch (a.operation) {
    case Operation::number:
      return literal(a.number, dialect_.scalar);
    case Operation::symbol:
      return namer_(a.name);
    case Operation::negate:
      return bracket("-" + operand(0, level_product), level_product, context);
    case Operation::add:
      return bracket(operand(0, level_sum) + " + " + operand(1, level_product), level_sum, context);
    case Operation::subtract:
      return bracket(operand(0, level_sum) + " - " + operand(1, level_product), level_sum, context);
    case Operation::multiply:
      return bracket(operand(0, level_product) + " * " + operand(1, level_unary), level_product,
                     context);
    case Operation::divide:
      return bracket(operand(0, level_product) + " / " + operand(1, level_unary), level_product,
                     context);
    case Operation::call: {
      std::string arguments;
      for (const Arithmetic& argument : a.operands) {
        arguments += (arguments.empty() ? "" : ", ") + print(argument, level_sum);
      }
      return call(a.name, arguments);
    }
  }
  internal_error("unknown operation");
}

}  // namespace hamgen
