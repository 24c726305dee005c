// The step of a member of a system whose sums stay loops, as routines.
#pragma once

#include "generator/program/environment.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// Adds the records Coefficients and Start and the routines that solve calls, and solve itself:
//
//   start.value   the stage, q first; q alone where the momenta are torn out: those are
//                 start.momentum
//   start.slope   grad H there, dH/dq first
void add_loop_member(Program& code, const Environment& environment, const LoweredStep& lowered);

}  // namespace hamgen
