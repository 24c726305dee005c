// What a study works on.
#pragma once

#include "generator/base/source_text.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"

namespace hamgen::app {

struct Setting {
  SourceText source;
  Request request;     // the method, with the model's sizes
  Model model;         // as the request reads it
  SceneRequest scene;  // complete_scene(model, scene) has its values
};

}  // namespace hamgen::app
