// Constants of linear terms in two parts in the gradients of kernels: see Note [constants in two
// parts] in step_builder.hpp.
#pragma once

#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/statement.hpp"
#include "generator/solvers/solve_plan.hpp"

namespace hamgen {

// In steps whose equations are solved, but for linear ones, which know what their products lose.
[[nodiscard]] bool splits_constants(const SolvePlan& plan);

// The kernels' gradients with products of both parts, which these statements define before all
// loops.  Constants that differ from element to element stay as they are.
std::vector<Statement> split_constants(std::vector<Kernel>& kernels, const Mechanics& mechanics);

}  // namespace hamgen
