// solve(par, h, z, carry, dz) of an explicit Runge-Kutta method.
#pragma once

#include "generator/program/environment.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

// With x = (q, p) as one array and f = J grad H of it:
//   f_i = f(x + h sum_j a_ij f_j),  dz = carry + h sum_i b_i f_i.
[[nodiscard]] Routine explicit_runge_kutta_routine(const Environment& environment,
                                                   const StageTable& table);

}  // namespace hamgen
