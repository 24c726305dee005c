#include "generator/formats/cpp_expression.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

enum Level { level_sum = 1, level_product = 2, level_unary = 3, level_atom = 4 };

std::string bracket(std::string text, int level, int context) {
  return level < context ? "(" + text + ")" : text;
}

bool is_reciprocal(const Expression& e) {
  return e.kind() == Kind::power && e.operands()[1] == Expression(-1);
}

}  // namespace

std::string CppExpression::operator()(const Expression& e) const { return print(e, level_sum); }

std::string CppExpression::call(const std::string& function, const std::string& arguments) const {
  functions_.insert(function);
  const Function* row = find_function(function);
  if (scalar_.digits == 113) {
    const std::string name = row != nullptr ? std::string(row->quad) : function + "q";
    return name + "(" + arguments + ")";
  }
  const std::string name = row != nullptr ? std::string(row->cpp) : function;
  if (builtins_) {
    std::string suffix(scalar_.suffix);
    std::ranges::transform(suffix, suffix.begin(), [](char c) { return c == 'L' ? 'l' : c; });
    return "__builtin_" + name + suffix + "(" + arguments + ")";
  }
  return "std::" + name + "(" + arguments + ")";
}

std::string CppExpression::power(const Expression& e) const {
  const Expression& base = e.operands()[0];
  const Expression& exponent = e.operands()[1];
  if (exponent.is_number()) {
    const Rational& n = exponent.number();
    if (n == Rational(1, 2)) return call("sqrt", print(base, level_sum));
    if (n > 0 && n <= 8 && n.get_den() == 1) {
      const std::string factor = print(base, level_atom);
      std::string text = factor;
      for (long i = 1; i < n.get_num().get_si(); ++i) text += " * " + factor;
      return text;
    }
  }
  return call("pow", print(base, level_sum) + ", " + print(exponent, level_sum));
}

std::string CppExpression::product(const Expression& e) const {
  const auto [coefficient, rest] = e.split_coefficient();
  std::string text = coefficient < 0 ? "-" : "";
  const Rational size = abs(coefficient);
  bool first = true;
  auto multiply = [&](const std::string& factor) {
    text += (first ? "" : " * ") + factor;
    first = false;
  };
  if (size != 1) multiply(literal(size, scalar_));
  const auto factors = rest.kind() == Kind::product ? rest.operands() : std::span(&rest, 1);
  for (const Expression& factor : factors) {
    if (is_reciprocal(factor)) continue;
    const bool power = factor.kind() == Kind::power;
    multiply(power ? print(factor, first ? level_product : level_unary)
                   : print(factor, level_unary));
  }
  if (first) multiply(literal(Rational(1), scalar_));
  std::string divisor;
  int divisors = 0;
  for (const Expression& factor : factors) {
    if (!is_reciprocal(factor)) continue;
    divisor += (divisors++ ? " * " : "") + print(factor.operands()[0], level_unary);
  }
  if (divisors == 1) return text + " / " + divisor;
  if (divisors > 1) return text + " / (" + divisor + ")";
  return text;
}

std::string CppExpression::print(const Expression& e, int context) const {
  switch (e.kind()) {
    case Kind::number:
      if (e.number() < 0) {
        return bracket("-" + literal(Rational(-e.number()), scalar_), level_product, context);
      }
      return literal(e.number(), scalar_);
    case Kind::symbol:
      return namer_(e.name());
    case Kind::function: {
      std::string arguments;
      for (const Expression& argument : e.operands()) {
        arguments += (arguments.empty() ? "" : ", ") + print(argument, level_sum);
      }
      return call(e.name(), arguments);
    }
    case Kind::power: {
      if (is_reciprocal(e)) {
        return bracket(literal(Rational(1), scalar_) + " / " + print(e.operands()[0], level_unary),
                       level_product, context);
      }
      const bool factors = e.operands()[1].is_number() && e.operands()[1].number() > 1 &&
                           e.operands()[1].number() <= 8 && e.operands()[1].number().get_den() == 1;
      return bracket(power(e), factors ? level_product : level_atom, context);
    }
    case Kind::product:
      return bracket(product(e), level_product, context);
    case Kind::sum: {
      // A positive term first, if there is one: b - a rather than -a + b.
      std::vector<std::string> terms;
      for (const Expression& term : e.operands()) {
        terms.push_back(print(term, terms.empty() ? level_sum : level_product));
      }
      for (std::size_t i = 0; i < terms.size(); ++i) {
        if (terms[i].starts_with('-')) continue;
        std::rotate(terms.begin(), terms.begin() + static_cast<std::ptrdiff_t>(i),
                    terms.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        break;
      }
      std::string text;
      for (const std::string& term : terms) {
        if (text.empty()) {
          text = term;
        } else if (term.starts_with('-')) {
          text += " - " + term.substr(1);
        } else {
          text += " + " + term;
        }
      }
      return bracket(text, level_sum, context);
    }
  }
  internal_error("unknown kind of expression");
}

}  // namespace hamgen
