// The facts of a step from its plan, its lowered form and its routines.
#pragma once

#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

[[nodiscard]] StepFacts describe_step(const LoweredStep& lowered, const Program& program);

}  // namespace hamgen
