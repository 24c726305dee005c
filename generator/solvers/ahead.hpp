// Where derivatives of H are evaluated a step ahead: Note [derivatives ahead] of program/ahead.hpp.
#pragma once

#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

// Of a member that is written out: is its only iteration Newton's, on one unknown, and does it wait
// for functions of this alone?
[[nodiscard]] bool waits_for_functions(const SolvePlan& plan);

}  // namespace hamgen
