// What a study works on.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "generator/base/source_text.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"

namespace hamgen::app {

// What a column of time is called beside those of a state: a driven system may have a t of its own,
// which need not begin at 0.
[[nodiscard]] inline const char* time_column(const std::vector<std::string>& state) {
  return std::ranges::find(state, "t") == state.end() ? "t" : "elapsed";
}

struct Setting {
  SourceText source;
  Request request;     // the method, with the model's sizes
  Model model;         // as the request reads it
  SceneRequest scene;  // complete_scene(model, scene) has its values
};

}  // namespace hamgen::app
