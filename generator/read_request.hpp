// The model as a request reads it.
#pragma once

#include "generator/algebra/scalar.hpp"
#include "generator/pipeline.hpp"

namespace hamgen {

// Defaults of parameters are literals of the emitted code: throws ModelError where the scalar has
// no number for one.
void require_defaults_in_range(const Model& model, const ScalarType& scalar);
// The scene the step is made for, with what has to stay because the scheme's options name it.
// Everything is observed where the modified Hamiltonian is wanted, which takes all of H.
[[nodiscard]] std::optional<SceneFacts> scene_facts(const Model& model, const Request& request);
// With what that scene makes of it: see specialise/; the model itself without a scene.
[[nodiscard]] FoldedModel fold_for_scene(const Model& model, const Request& request);
// Loops know one set of parameters for all degrees of freedom.
[[nodiscard]] bool may_keep_sums(const Request& request);

}  // namespace hamgen
