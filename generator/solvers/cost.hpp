// What the ways to solve a step cost: rough counts of operations, by which the planner decides.
#pragma once

#include "generator/mechanics/mechanics.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

// What filling in and eliminating the matrix of Newton's iteration costs, in evaluations of the
// equations; at most 13, which is what a fixed point takes that halves its error every time, or 26
// where momenta are not torn out (`reduced`) and it halves it every second time.  The kernels are
// kernels_of_matrix().
[[nodiscard]] int matrix_work(const std::vector<Kernel>& kernels, const ArrayMatrix& matrix,
                              bool reduced, NumbersOf numbers);

}  // namespace hamgen
