// What is remembered from step to step of the solutions of equations that are written out.
#pragma once

#include <vector>

#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// Of the blocks that are solved for, null where there is none, with so many unknowns in all.
[[nodiscard]] Record start_record(const std::vector<const Solve*>& solves, int unknowns);

// Does its rule compare its matrix with that of the step before?  It is the exact one, and
// symmetric.
[[nodiscard]] bool is_compared(const Solve& solve);

// The rules of that record by which the iterations of the routine "solve" end.
[[nodiscard]] std::vector<RuleOfNewton> rules_of(const Routine& solve);

}  // namespace hamgen
