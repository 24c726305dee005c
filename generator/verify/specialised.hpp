// Is the system that a scene is run with the one it was made from?
#pragma once

#include "generator/specialise/specialisation.hpp"
#include "generator/verify/sample_points.hpp"
#include "generator/verify/verdict.hpp"

namespace hamgen {

// None of them folded: what a scene puts in is not what the model says.
[[nodiscard]] Model with_free_parameters(Model model);

// That what was left out of `model` for the scene may be: the scene has the values that were put
// in; H with them is H; where the scene begins, the variables that rest are zero, and nothing in
// J grad H or C moves them; no equation of what is kept has what is not observed; and the system
// that is left is H, and C, in what is kept.  H is derived anew.  Nothing is taken from what
// decided to leave it out.
[[nodiscard]] Finding prove_specialised(const Model& model, const FoldedModel& folded,
                                        const Specialised& system, const SceneFacts& scene,
                                        const Surroundings& around = {});

}  // namespace hamgen
