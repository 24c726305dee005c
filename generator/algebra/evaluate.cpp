#include "generator/algebra/evaluate.hpp"

#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

std::optional<Rational> evaluate(const Expression& e, const Values& values) {
  if (e.is_number()) return e.number();
  if (e.kind() == Kind::symbol) {
    if (const auto it = values.find(e.name()); it != values.end()) return it->second;
    return e.name() == "pi" ? evaluate_function("pi", {}) : std::nullopt;
  }
  std::vector<Rational> operands;
  for (const Expression& operand : e.operands()) {
    const std::optional<Rational> value = evaluate(operand, values);
    if (!value) return std::nullopt;
    operands.push_back(*value);
  }
  switch (e.kind()) {
    case Kind::sum: {
      Rational sum = 0;
      for (const Rational& operand : operands) sum += operand;
      return sum;
    }
    case Kind::product: {
      Rational product = 1;
      for (const Rational& operand : operands) product *= operand;
      return product;
    }
    case Kind::power:
      return evaluate_power(operands[0], operands[1]);
    case Kind::function:
      return evaluate_function(e.name(), operands);
    case Kind::number:
    case Kind::symbol:
      break;
  }
  internal_error("handled above");
}

}  // namespace hamgen
