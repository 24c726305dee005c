// What the request wants of a step besides what its plan says.
#pragma once

#include "generator/program/lowered_step.hpp"
#include "generator/request.hpp"
#include "generator/specialise/specialisation.hpp"

namespace hamgen {

// for_scene: are the initial values a scene's?  Throws UsageError where terms of the modified
// Hamiltonian are wanted that the scheme does not have.
[[nodiscard]] StepWishes step_wishes(const Request& request, const Specialised& system,
                                     const SolvePlan& plan, bool for_scene);

// What the step is without by these wishes, and why.
[[nodiscard]] std::vector<std::string> left_out_by(const StepWishes& wishes);

}  // namespace hamgen
