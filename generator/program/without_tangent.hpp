// Whether the linearisation of a step is written: tangent(par, h, z, dz, m) for the step that moves
// z by dz.
#pragma once

#include <optional>
#include <string>

#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

// Why the tangent map of the step of this plan is not written, if it is not.
[[nodiscard]] std::optional<std::string> without_tangent(const SolvePlan& plan);

}  // namespace hamgen
