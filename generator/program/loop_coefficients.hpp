// What a member's step of a system in loops takes of h and the parameters alone.
#pragma once

#include <optional>

#include "generator/program/coefficients.hpp"
#include "generator/program/state_rounding.hpp"
#include "generator/program/step_weights.hpp"

namespace hamgen {

// The weights, and where the momenta are torn out, each one number or an array:
//   k.drift   dH/dp_i at p = 0
//   k.mass    d2H/dp_i^2
//   k.scale   D with the matrix I + D V''
// and what the unknowns of an iteration are rounded with besides, k.beside_q, k.beside_p and
// k.reach: see Note [forces that cancel].  None if the step takes nothing.
[[nodiscard]] std::optional<Coefficients> loop_coefficients(
    const Environment& environment, const StepWeights& weights, const ArrayPlan& plan, bool tangent,
    bool tells_momenta, const std::optional<StateRounding>& beside);

// D of the matrix I + D V'', where all d2H/dp_i^2 are `mass`.
[[nodiscard]] Expression scale_of(const StepWeights& weights, const Expression& mass);

// The index of k.mass: none if all masses are one.
[[nodiscard]] std::vector<AffineIndex> loop_mass_index(const ArrayPlan& plan,
                                                       const std::string& index);

}  // namespace hamgen
