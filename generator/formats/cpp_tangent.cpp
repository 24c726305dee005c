#include "generator/formats/cpp_tangent.hpp"

#include <fmt/format.h>

namespace hamgen {

std::optional<std::string> without_tangent(const Program& program) {
  const StepEquations& equations = program.plan.equations;
  if (!equations.has_exact_hessian()) {
    return "the Hessian of the K that stands in for H is too long";
  }
  // The matrix, and that of the stages, are on the stack.
  constexpr int kMost = 512;
  const int size = 2 * equations.mechanics.degrees_of_freedom;
  const int stages =
      program.plan.stage_solver ? static_cast<int>(program.sequence.stages.weight.size()) : 1;
  if (size * stages <= kMost) return {};
  return fmt::format("its equations have {} unknowns, of at most {}", size * stages, kMost);
}

}  // namespace hamgen
