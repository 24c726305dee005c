// Checks that every name of an expression is known, of the right shape, and allowed where it is.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "generator/language/symbols.hpp"

namespace hamgen {

// What an expression may use besides numbers, pi and sizes.
struct Role {
  std::string_view what;    // "the value of a parameter"
  std::string_view allows;  // "earlier parameters, sizes and numbers"
  std::set<SymbolKind> kinds;
  // Parameters, definitions and sizes must be declared before this place, if there is one.
  std::optional<std::size_t> before;
};

[[nodiscard]] Role size_role(std::optional<std::size_t> before);
[[nodiscard]] Role parameter_role(std::optional<std::size_t> before);
[[nodiscard]] Role formula_role(std::optional<std::size_t> before);  // H, let, invariant

// True if nothing is wrong.  `indices` are free indices the expression may use.
bool check_names(const NodePtr& node, const Role& role, Symbols& symbols,
                 std::vector<std::string> indices = {});

// Every name in an expression, indices of sums among them.
[[nodiscard]] std::set<std::string> names_in(const NodePtr& node);

}  // namespace hamgen
