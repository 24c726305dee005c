// A model as JSON: what it declares, as it is written.
#pragma once

#include <nlohmann/json.hpp>

#include "generator/language/model.hpp"

namespace hamgen::app {

// system, H, sizes, coordinates, momenta, parameters, invariants, events, scenes: each a list of
// objects with a name, and what belongs to it: unit, comment, range [first, last], value or values
// (as text), of a scene h, steps and every.
[[nodiscard]] nlohmann::ordered_json model_json(const Model& model);

}  // namespace hamgen::app
