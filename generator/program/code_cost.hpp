// What routines cost, their loops counted out.
#pragma once

#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

struct StepCost {
  Cost iteration;  // what is done once an iteration of solve
  Cost besides;    // and once a step
};
// Elimination within a band, or of a full matrix, is counted too, that by Eigen is not.
[[nodiscard]] StepCost step_cost(const Program& code);
// Of a step with all its substeps, additions for a measure: a division or function counts for ten,
// and a body that is not Newton's is taken to be done eight times.
[[nodiscard]] double operations_per_step(const Program& code);
// Of a call of the routine of this name, nothing if there is none.
[[nodiscard]] Cost routine_cost(const Program& code, const std::string& name);

}  // namespace hamgen
