// An expression in the language's own notation.
#include "generator/algebra/expression.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

// Binding strength of the language's operators.
enum Level { level_sum = 1, level_product = 2, level_power = 4, level_atom = 5 };

std::string print(const Expression& e, int context);

std::string parenthesised(std::string text, int level, int context) {
  return level < context ? "(" + text + ")" : text;
}

std::string print_power(const Expression& base, const Rational& exponent) {
  if (exponent == 1) return print(base, level_product + 1);
  if (exponent == Rational(1, 2)) return "sqrt(" + print(base, level_sum) + ")";
  const std::string text =
      exponent.get_den() == 1 && exponent > 0 ? to_text(exponent) : "(" + to_text(exponent) + ")";
  return print(base, level_atom) + "^" + text;
}

std::string print_product(const Expression& e) {
  auto [coefficient, rest] = e.split_coefficient();
  std::string above = coefficient < 0 ? "-" : "";
  std::vector<std::string> over;
  std::vector<std::string> under;
  const Rational size = abs(coefficient);
  if (size.get_num() != 1) over.push_back(size.get_num().get_str());
  const auto factors = rest.kind() == Kind::product ? rest.operands() : std::span(&rest, 1);
  for (const Expression& factor : factors) {
    if (factor.is_number()) continue;
    if (factor.kind() == Kind::power && factor.operands()[1].is_number() &&
        factor.operands()[1].number() < 0) {
      under.push_back(print_power(factor.operands()[0], -factor.operands()[1].number()));
    } else {
      over.push_back(print(factor, level_product + 1));
    }
  }
  if (size.get_den() != 1) under.insert(under.begin(), size.get_den().get_str());
  if (over.empty()) over.emplace_back("1");
  for (std::size_t i = 0; i < over.size(); ++i) above += (i ? "*" : "") + over[i];
  for (const std::string& factor : under) above += "/" + factor;
  return above;
}

std::string print(const Expression& e, int context) {
  switch (e.kind()) {
    case Kind::number: {
      const bool plain = e.number() >= 0 && e.number().get_den() == 1;
      return parenthesised(to_text(e.number()), plain ? level_atom : level_product, context);
    }
    case Kind::symbol:
      return e.name();
    case Kind::function: {
      std::string text = e.name() + "(";
      for (std::size_t i = 0; i < e.operands().size(); ++i) {
        text += (i ? ", " : "") + print(e.operands()[i], level_sum);
      }
      return text + ")";
    }
    case Kind::power:
      if (e.operands()[1].is_number()) {
        const Rational& exponent = e.operands()[1].number();
        if (exponent < 0) return parenthesised(print_product(e), level_product, context);
        return parenthesised(print_power(e.operands()[0], exponent),
                             exponent == Rational(1, 2) ? level_atom : level_power, context);
      }
      return parenthesised(
          print(e.operands()[0], level_atom) + "^" + print(e.operands()[1], level_atom),
          level_power, context);
    case Kind::product:
      return parenthesised(print_product(e), level_product, context);
    case Kind::sum: {
      std::string text;
      for (const Expression& term : e.operands()) {
        const std::string piece = print(term, level_sum);
        if (text.empty()) {
          text = piece;
        } else if (piece.starts_with('-')) {
          text += " - " + piece.substr(1);
        } else {
          text += " + " + piece;
        }
      }
      return parenthesised(text, level_sum, context);
    }
  }
  internal_error("unknown kind of expression");
}

}  // namespace

std::string to_text(const Expression& e) { return print(e, level_sum); }

}  // namespace hamgen
