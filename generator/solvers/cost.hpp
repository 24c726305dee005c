// What the ways to solve a step cost: rough counts of operations, by which the planner decides.
#pragma once

#include "generator/mechanics/mechanics.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

// What filling in and eliminating the matrix of Newton's iteration costs, in evaluations of the
// equations; at most 13, which is what a fixed point takes that halves its error every time, or 26
// where that is the coordinates', and the momenta take as many.
[[nodiscard]] int matrix_work(const Mechanics& mechanics, const ArrayMatrix& matrix, bool reduced,
                              NumbersOf numbers);

}  // namespace hamgen
