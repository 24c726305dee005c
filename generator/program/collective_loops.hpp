// Loops of the sums that H is a function of.
#pragma once

#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

// Are they parts of such sums that one loop computes together?
[[nodiscard]] bool run_beside(const Kernel& a, const Kernel& b);

// The kernels whose gradients add up to that of H: those of the sums times the slopes of H by them,
// together where they run beside each other.
[[nodiscard]] std::vector<Kernel> weighted_kernels(const Mechanics& mechanics);

// Values computed together, by names of their own: loops that follow have temporaries too.
[[nodiscard]] Evaluation evaluate_apart(const std::vector<Expression>& values,
                                        const std::string& name);

}  // namespace hamgen
