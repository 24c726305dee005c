// The system that a step is made for: in which variables, and whether its sums stay loops.
#pragma once

#include <optional>

#include "generator/language/model.hpp"
#include "generator/request.hpp"
#include "generator/specialise/specialisation.hpp"

namespace hamgen {

// Without what the scene, if there is one, does not need.  Other variables where a step has fewer
// operations in them; loops, if H can be written out too, where these are quicker.
[[nodiscard]] Specialised choose_system(const Model& model, const std::optional<SceneFacts>& scene,
                                        const Request& request);

}  // namespace hamgen
