// The functions of a system whose sums stay loops, each a loop over the instances of every kernel:
//   energy(par, z)
//   potential_gradient(par, q, dq), kinetic_gradient(par, p, dp), gradient(par, q, p, dq, dp)
//   masses(par, dp)                  d2H/dp_i^2, which is constant
//   hessian(par, [q, p,] put)        put(row, column, value), repeated entries to be added
#pragma once

#include <string>

#include "generator/program/environment.hpp"

namespace hamgen {

// Which kernels a function sums, by what they read.
enum class Part { all, potential, kinetic };

[[nodiscard]] Routine kernel_energy(const Environment& environment, const Mechanics& mechanics);
[[nodiscard]] Routine kernel_gradient(const Environment& environment, const Mechanics& mechanics,
                                      std::string name, Part part);
// Of a separable H: the two one after the other.
[[nodiscard]] Routine both_gradients(const Environment& environment);
// vector_field(par, x, f): J grad H at the state as one array.
[[nodiscard]] Routine array_vector_field(const Environment& environment);
[[nodiscard]] Routine kernel_masses(const Environment& environment, const Mechanics& mechanics);
[[nodiscard]] Routine kernel_hessian(const Environment& environment, const Mechanics& mechanics,
                                     Part part);

}  // namespace hamgen
