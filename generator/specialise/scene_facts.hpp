// What is known of the scene that an integrator is made for.
#pragma once

#include <set>
#include <string>

#include "generator/language/scene.hpp"

namespace hamgen {

struct SceneFacts {
  SceneRequest asked;
  SceneValues values;          // what it means
  std::set<std::string> kept;  // variables and parameters that may get other values
  bool sees_all = false;       // degrees of freedom that nothing observed depends on are wanted
};

}  // namespace hamgen
