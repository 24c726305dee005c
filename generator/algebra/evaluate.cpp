#include "generator/algebra/evaluate.hpp"

#include "generator/algebra/functions.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

std::optional<Rational> combined(const Expression& e, const std::vector<Rational>& operands) {
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
  internal_error("handled by the caller");
}

}  // namespace

std::optional<Rational> evaluate(const Expression& e, const Values& values) {
  std::map<const void*, std::optional<Rational>> known;  // a graph, not a tree
  const auto visit = [&](auto&& self, const Expression& node) -> std::optional<Rational> {
    if (node.is_number()) return node.number();
    if (node.kind() == Kind::symbol) {
      if (const auto it = values.find(node.name()); it != values.end()) return it->second;
      return node.name() == "pi" ? evaluate_function("pi", {}) : std::nullopt;
    }
    if (const auto it = known.find(node.identity()); it != known.end()) return it->second;
    std::vector<Rational> operands;
    for (const Expression& operand : node.operands()) {
      const std::optional<Rational> value = self(self, operand);
      if (!value) return std::nullopt;
      operands.push_back(*value);
    }
    return known[node.identity()] = combined(node, operands);
  };
  return visit(visit, e);
}

}  // namespace hamgen
