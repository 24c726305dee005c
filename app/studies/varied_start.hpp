// Where runs begin that differ in some values.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::app {

class VariedStart {
 public:
  // `scene` without these names' values; they are elements of coordinates, momenta and parameters.
  // All references live as long.  Throws what complete_scene and initial_values throw, but not for
  // a state where H is not defined.
  VariedStart(const PluginSource& plugin, const runtime::Library& library, SceneRequest scene,
              std::vector<std::string> names);

  struct Start {
    SceneValues scene;
    runtime::InitialValues values;
  };
  // With these values, one a name; empty where nothing can begin: H, or what the scene computes
  // from the values, is not defined, or a value is beyond the scalar's range.  From any thread.
  [[nodiscard]] std::optional<Start> at(std::span<const double> values) const;

 private:
  [[nodiscard]] SceneValues scene_with(std::span<const double> values) const;
  [[nodiscard]] std::optional<Start> computed(std::span<const double> values) const;
  void find_places();

  const PluginSource& plugin_;
  const runtime::Library& library_;
  SceneRequest request_;
  std::vector<std::string> names_;
  std::size_t parameters_ = 0, n_ = 0;
  std::vector<std::size_t> rows_;  // of the names: among parameters, then q, then p, of the model
  // Where the scene computes nothing from the values: what they replace of a start.
  struct Place {
    std::size_t name = 0;
    bool is_parameter = false;
    std::size_t at = 0;
  };
  bool direct_ = false;
  std::vector<Place> places_;
  SceneValues base_scene_;
  runtime::InitialValues base_;
};

}  // namespace hamgen::app
