#include "app/output/math_markup.hpp"

#include <span>
#include <utility>
#include <vector>

#include "generator/base/diagnostic.hpp"
#include "generator/language/model.hpp"

namespace hamgen::app {
namespace {

MathFormula formula_of(const NodePtr& node);
MathFormula formula_of(const Expression& e);

MathFormula formula_of(const NumberNode& number) {
  return math_number(to_text(std::make_shared<const Node>(Node{.value = number})));
}

MathFormula formula_of(const NameNode& name) {
  return name.subscript ? with_subscript(name.name, formula_of(name.subscript))
                        : math_symbol(name.name);
}

MathFormula formula_of(const NegateNode& negate) { return negated(formula_of(negate.operand)); }

MathFormula formula_of(const BinaryNode& binary) {
  const MathFormula left = formula_of(binary.left);
  const MathFormula right = formula_of(binary.right);
  switch (binary.operation) {
    case BinaryOperator::add:
      return sum_of(left, right);
    case BinaryOperator::subtract:
      return difference_of(left, right);
    case BinaryOperator::multiply:
      return product_of(left, right);
    case BinaryOperator::divide:
      return quotient_of(left, right);
    case BinaryOperator::power:
      return power_of(left, right);
  }
  internal_error("unknown operator");
}

MathFormula formula_of(const CallNode& call) {
  std::vector<MathFormula> arguments;
  for (const NodePtr& argument : call.arguments) arguments.push_back(formula_of(argument));
  return call_of(call.function, arguments);
}

MathFormula formula_of(const SumNode& sum) {
  MathFormula result = formula_of(sum.body);
  for (auto range = sum.ranges.rbegin(); range != sum.ranges.rend(); ++range)
    result = sum_over(range->index, formula_of(range->lower), formula_of(range->upper), result);
  return result;
}

MathFormula formula_of(const NodePtr& node) {
  return std::visit([](const auto& each) { return formula_of(each); }, node->value);
}

// A literal, with the digits the language would give it.
MathFormula integer(const Integer& value) { return formula_of(NumberNode{.value = value}); }

// -1/2 is (-1)/2: a sign binds more tightly than a fraction's bar.
MathFormula formula_of(const Rational& value) {
  const MathFormula size = integer(abs(value.get_num()));
  const MathFormula above = value < 0 ? negated(size) : size;
  return value.get_den() == 1 ? above : quotient_of(above, integer(value.get_den()));
}

MathFormula formula_of_power(const Expression& base, const Rational& exponent) {
  if (exponent == 1) return formula_of(base);
  if (exponent == Rational(1, 2)) return call_of("sqrt", {formula_of(base)});
  return power_of(formula_of(base), formula_of(exponent));
}

bool is_reciprocal(const Expression& e) {
  return e.kind() == Kind::power && e.operands()[1].is_number() && e.operands()[1].number() < 0;
}

// Integers first, above and below the bar; the sign belongs to the first factor above.
MathFormula formula_of_product(const Expression& e) {
  const auto [coefficient, rest] = e.split_coefficient();
  const Rational size = abs(coefficient);
  std::vector<MathFormula> over;
  std::vector<MathFormula> under;
  if (size.get_num() != 1) over.push_back(integer(size.get_num()));
  if (size.get_den() != 1) under.push_back(integer(size.get_den()));
  for (const Expression& factor :
       rest.kind() == Kind::product ? rest.operands() : std::span(&rest, 1)) {
    if (factor.is_number()) continue;
    if (is_reciprocal(factor))
      under.push_back(formula_of_power(factor.operands()[0], -factor.operands()[1].number()));
    else
      over.push_back(formula_of(factor));
  }
  if (over.empty()) over.push_back(integer(1));
  MathFormula result = coefficient < 0 ? negated(over.front()) : over.front();
  for (const MathFormula& factor : std::span(over).subspan(1)) result = product_of(result, factor);
  for (const MathFormula& factor : under) result = quotient_of(result, factor);
  return result;
}

MathFormula formula_of_sum(std::span<const Expression> terms) {
  MathFormula result = formula_of(terms.front());
  for (const Expression& term : terms.subspan(1)) {
    result = term.split_coefficient().first < 0 ? difference_of(result, formula_of(-term))
                                                : sum_of(result, formula_of(term));
  }
  return result;
}

MathFormula formula_of(const Expression& e) {
  switch (e.kind()) {
    case Kind::number:
      return formula_of(e.number());
    case Kind::symbol:
      return math_variable(e.name());
    case Kind::function: {
      std::vector<MathFormula> arguments;
      for (const Expression& argument : e.operands()) arguments.push_back(formula_of(argument));
      return call_of(e.name(), arguments);
    }
    case Kind::power:
      if (is_reciprocal(e)) return formula_of_product(e);
      if (e.operands()[1].is_number())
        return formula_of_power(e.operands()[0], e.operands()[1].number());
      return power_of(formula_of(e.operands()[0]), formula_of(e.operands()[1]));
    case Kind::product:
      return formula_of_product(e);
    case Kind::sum:
      return formula_of_sum(e.operands());
  }
  internal_error("unknown kind of expression");
}

}  // namespace

MathFormula math_formula(const NodePtr& node) { return formula_of(node); }

MathFormula math_formula(const Expression& expression) { return formula_of(expression); }

MathFormula math_variable(const std::string& name) {
  const std::size_t bracket = name.find('[');
  if (bracket == std::string::npos) return math_symbol(name);
  return with_subscript(name.substr(0, bracket),
                        math_number(name.substr(bracket + 1, name.size() - bracket - 2)));
}

}  // namespace hamgen::app
