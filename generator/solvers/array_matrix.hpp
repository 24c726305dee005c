// Which matrix the step of a system in loops is solved with, by the pattern of its entries.
#pragma once

#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

// The matrix of Newton's iteration on the coordinates (the momenta torn out) or on all stage
// values. Empty if without Eigen it is too large.
[[nodiscard]] std::optional<ArrayMatrix> choose_matrix(const Mechanics& mechanics,
                                                       const FamilyParameters& member, bool reduced,
                                                       bool eigen);

// Of sums that are loops: is H quadratic, for every t where that is known?
[[nodiscard]] bool has_constant_matrix(const Mechanics& mechanics, const FamilyParameters& member);
// Of sums that are loops: is the kinetic energy a sum of squares of momenta?
[[nodiscard]] bool has_diagonal_kinetic_energy(const Mechanics& mechanics);
// d^2 H/dp_i^2 then, if it is the same for all i; p_t may be `apart`, which has none.
[[nodiscard]] std::optional<Expression> uniform_mass(const Mechanics& mechanics,
                                                     bool apart_from_time = false);

}  // namespace hamgen
