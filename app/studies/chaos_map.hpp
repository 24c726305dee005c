// An indicator of chaos over a plane of initial values or parameters.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/chaos.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"

namespace hamgen::app {

// Evenly spaced values of a parameter, a coordinate or a momentum.
struct ChaosAxis {
  std::string name;
  std::vector<double> values;
};

struct ChaosCell {
  runtime::Status status = runtime::Status::done;
  std::optional<ChaosSample> end;  // empty where no step was done
  std::string reason;              // why the cell has no initial state
};

struct ChaosMapRequest {
  const PluginSource* plugin = nullptr;
  std::shared_ptr<const runtime::Library> library;
  SceneRequest scene;
  std::vector<ChaosAxis> axes;                      // one or two
  std::function<void(long done)> on_progress = {};  // of the cells
  StopFlag stop = nullptr;
};

// Row by row of the second axis; those that were done when it was stopped.
[[nodiscard]] std::vector<ChaosCell> chaos_map(const ChaosMapRequest& request);

}  // namespace hamgen::app
