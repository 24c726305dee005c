#include "generator/program/without_tangent.hpp"

#include <fmt/format.h>

namespace hamgen {

std::optional<std::string> without_tangent(const SolvePlan& plan) {
  if (!plan.equations.has_exact_hessian()) {
    return "the Hessian of the K that stands in for H is too long";
  }
  if (plan.sweeps && plan.equations.function)
    return "sweeps with a K that stands in for H have none";
  if (!plan.equations.mechanics.sums.empty())
    return "H is a function of sums over all elements, whose second derivatives are not made";
  // The matrix, and that of the stages, are on the stack.
  constexpr int kMost = 512;
  const int size = 2 * plan.equations.mechanics.degrees_of_freedom;
  const auto* tableau = std::get_if<RungeKutta>(&plan.equations.scheme.method);
  const int stages = plan.stage_solver ? static_cast<int>(tableau->b.size()) : 1;
  if (size * stages <= kMost) return {};
  return fmt::format("its equations have {} unknowns, of at most {}", size * stages, kMost);
}

}  // namespace hamgen
