// Symbols of an expression, found and replaced.
#include <unordered_set>

#include "generator/algebra/expression.hpp"
#include "generator/base/budget.hpp"

namespace hamgen {

namespace {

void collect_unseen(const Expression& e, std::unordered_set<const void*>& seen,
                    std::set<std::string>& names) {
  spend(Resource::work, 1);
  if (!seen.insert(e.identity()).second) return;
  if (e.kind() == Kind::symbol) names.insert(e.name());
  for (const Expression& operand : e.operands()) collect_unseen(operand, seen, names);
}

}  // namespace

void collect_symbols(const Expression& e, std::set<std::string>& names) {
  std::unordered_set<const void*> seen;
  collect_unseen(e, seen, names);
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
  std::unordered_set<const void*> seen;
  std::unordered_set<const void*> seen_below;  // a function, a root or a reciprocal
  auto visit = [&](auto&& self, const Expression& node) -> void {
    spend(Resource::work, 1);
    if (!seen.insert(node.identity()).second) return;
    const bool natural_power = node.kind() == Kind::power && node.operands()[1].is_number() &&
                               node.operands()[1].number() > 0 &&
                               node.operands()[1].number().get_den() == 1;
    if (node.kind() == Kind::function || (node.kind() == Kind::power && !natural_power)) {
      collect_unseen(node, seen_below, names);
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
    spend(Resource::work, 1);
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
    const Expression result = changed ? with_operands(node, std::move(operands)) : node;
    done.emplace(node.identity(), result);
    return result;
  };
  std::vector<Expression> results;
  for (const Expression& e : values) results.push_back(visit(visit, e));
  return results;
}

}  // namespace hamgen
