// THE LIST of ways to solve the implicit step that a user can ask for.
#pragma once

#include <span>
#include <string_view>

namespace hamgen {

struct NamedSolver {
  std::string_view name;         // "newton", "fixed-point", "sweeps:K"
  std::string_view description;  // one line
};

[[nodiscard]] std::span<const NamedSolver> all_solvers();

}  // namespace hamgen
