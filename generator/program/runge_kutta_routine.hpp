// solve(par, h, z, carry, dz) of an explicit Runge-Kutta method; of a large system with what it
// works with in a record, start.
#pragma once

#include "generator/program/environment.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"
#include "generator/program/routine_builder.hpp"

namespace hamgen {

// With x = (q, p) as one array and f = J grad H of it:
//   f_i = f(x + h sum_j a_ij f_j),  dz = carry + h sum_i b_i f_i.
void add_explicit_runge_kutta(Program& code, const Environment& environment,
                              const StageTable& table);
// The array of J grad H at a stage.
[[nodiscard]] std::string explicit_slope(std::size_t stage);

// The array `name` of 2n numbers is the state.
void read_state(RoutineBuilder& b, Body& body, const Environment& environment,
                const std::string& state, const Place& array, bool arrays);

}  // namespace hamgen
