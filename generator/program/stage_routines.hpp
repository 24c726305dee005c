// The step of an implicit Runge-Kutta method, as routines.
//
// With L_i = h b_i f(Y_i) the stages are Y_i = z + sum coupling_ij L_j and Z = z + sum L_i.  In the
// routines all are one array (StageLayout): start.value the Y_i, start.slope the L_i.
#pragma once

#include "generator/program/environment.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"
#include "generator/program/routine_builder.hpp"

namespace hamgen {

// Adds the records Coefficients and Start, and solve with what it calls.  There are vector_field
// or vector_fields and, where Newton is among the solvers, hessian for the state as one array, and
// where there is a second order forces.
void add_stages(Program& code, const Environment& environment, const LoweredStep& lowered);

}  // namespace hamgen
