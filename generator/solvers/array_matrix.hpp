// Which matrix the step of a system in loops is solved with, by the pattern of its entries.
#pragma once

#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

// The matrix of Newton's iteration on the coordinates (the momenta torn out) or on all stage
// values.
[[nodiscard]] ArrayMatrix choose_matrix(const Mechanics& mechanics, const FamilyParameters& member,
                                        bool reduced);

}  // namespace hamgen
