// Symbols of an expression, found and replaced.
#include "generator/algebra/expression.hpp"

namespace hamgen {

void collect_symbols(const Expression& e, std::set<std::string>& names) {
  std::set<const void*> seen;
  auto visit = [&](auto&& self, const Expression& node) -> void {
    if (!seen.insert(node.identity()).second) return;
    if (node.kind() == Kind::symbol) names.insert(node.name());
    for (const Expression& operand : node.operands()) self(self, operand);
  };
  visit(visit, e);
}

std::set<std::string> symbols(const Expression& e) {
  std::set<std::string> names;
  collect_symbols(e, names);
  return names;
}

bool depends_on(const Expression& e, const std::string& symbol) {
  return symbols(e).contains(symbol);
}

std::set<std::string> non_polynomial_symbols(const Expression& e) {
  std::set<std::string> names;
  std::set<const void*> seen;
  auto visit = [&](auto&& self, const Expression& node) -> void {
    if (!seen.insert(node.identity()).second) return;
    const bool natural_power = node.kind() == Kind::power && node.operands()[1].is_number() &&
                               node.operands()[1].number() > 0 &&
                               node.operands()[1].number().get_den() == 1;
    if (node.kind() == Kind::function || (node.kind() == Kind::power && !natural_power)) {
      collect_symbols(node, names);
      return;
    }
    for (const Expression& operand : node.operands()) self(self, operand);
  };
  visit(visit, e);
  return names;
}

Expression substitute(const Expression& e, const Substitution& replacements) {
  return substitute(std::span(&e, 1), replacements)[0];
}

std::vector<Expression> substitute(std::span<const Expression> values,
                                   const Substitution& replacements) {
  std::unordered_map<const void*, Expression> done;
  auto visit = [&](auto&& self, const Expression& node) -> Expression {
    if (node.is_number()) return node;
    if (node.kind() == Kind::symbol) {
      const auto it = replacements.find(node.name());
      return it == replacements.end() ? node : it->second;
    }
    if (const auto it = done.find(node.identity()); it != done.end()) return it->second;
    std::vector<Expression> operands;
    bool changed = false;
    for (const Expression& operand : node.operands()) {
      operands.push_back(self(self, operand));
      changed = changed || operands.back().identity() != operand.identity();
    }
    Expression result = node;
    if (changed) {
      switch (node.kind()) {
        case Kind::sum:
          result = Expression::sum(std::move(operands));
          break;
        case Kind::product:
          result = Expression::product(std::move(operands));
          break;
        case Kind::power:
          result = Expression::power(operands[0], operands[1]);
          break;
        case Kind::function:
          result = Expression::apply(node.name(), std::move(operands));
          break;
        case Kind::number:
        case Kind::symbol:
          break;
      }
    }
    done.emplace(node.identity(), result);
    return result;
  };
  std::vector<Expression> results;
  for (const Expression& e : values) results.push_back(visit(visit, e));
  return results;
}

}  // namespace hamgen
