// What an instance of a kernel computes, and what is the same for all of them.
#pragma once

#include <string>
#include <vector>

#include "generator/mechanics/kernel.hpp"
#include "generator/program/lowered_step.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

struct KernelEvaluation : Evaluation {
  std::vector<Statement> before;  // the loop
};
// Values in the symbols of the kernel, computed together, with symbols for its indices: what is
// made of parameters and of elements that stand still is computed before the loop, as cos(w*t) is,
// where there are such elements.
[[nodiscard]] KernelEvaluation evaluate(const Kernel& kernel, const std::vector<Expression>& values,
                                        const Substitution& indices);

// A loop's index: the user's name, unless the routine has something of that name.
[[nodiscard]] std::string loop_index(const Routine& routine, const std::string& name);
[[nodiscard]] AffineIndex renamed(const Routine& routine, const AffineIndex& index);

}  // namespace hamgen
