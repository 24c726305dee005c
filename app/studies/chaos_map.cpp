#include "app/studies/chaos_map.hpp"

#include <algorithm>

#include "app/studies/initial_data.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

// The scene with the axes' values in place of its own.
SceneValues scene_at(const ChaosMapRequest& request, const std::vector<double>& at) {
  const std::vector<std::string> parameters = element_names(request.plugin->model.parameters);
  SceneRequest scene = request.scene;
  for (std::size_t i = 0; i < request.axes.size(); ++i) {
    const std::string& name = request.axes[i].name;
    const bool is_parameter = std::ranges::find(parameters, name) != parameters.end();
    (is_parameter ? scene.set : scene.initial).emplace_back(name, runtime::number_text(at[i]));
  }
  return complete_scene(request.plugin->model, scene);
}

ChaosCell cell_at(const ChaosMapRequest& request, const std::vector<double>& at) {
  ChaosCell cell;
  try {
    const SceneValues scene = scene_at(request, at);
    const Chaos found = chaos({.library = request.library,
                               .start = initial_values(*request.plugin, scene, *request.library),
                               .steps = *scene.steps,
                               .stop = request.stop});
    cell.status = found.status;
    if (!found.samples.empty()) cell.end = found.samples.back();
  } catch (const ModelError& error) {
    cell.status = runtime::Status::undefined;
    cell.reason = error.what();
  }
  return cell;
}

}  // namespace

std::vector<ChaosCell> chaos_map(const ChaosMapRequest& request) {
  std::vector<ChaosCell> cells;
  const std::size_t across = request.axes[0].values.size();
  const std::size_t up = request.axes.size() > 1 ? request.axes[1].values.size() : 1;
  for (std::size_t j = 0; j < up; ++j) {
    for (std::size_t i = 0; i < across; ++i) {
      if (is_stopped(request.stop)) return cells;
      std::vector<double> at = {request.axes[0].values[i]};
      if (request.axes.size() > 1) at.push_back(request.axes[1].values[j]);
      cells.push_back(cell_at(request, at));
      if (request.on_progress) request.on_progress(static_cast<long>(cells.size()));
    }
  }
  return cells;
}

}  // namespace hamgen::app
