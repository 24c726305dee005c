// The Program of a plan: its routines by the builder of its method.
#pragma once

#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

[[nodiscard]] Program build_program(const SolvePlan& plan, const StepWishes& wishes = {});
[[nodiscard]] Program build_program(const LoweredStep& lowered);

}  // namespace hamgen
