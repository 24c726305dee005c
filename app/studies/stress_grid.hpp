// The cells of a stress grid: a run's initial values at any place.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/stress.hpp"
#include "generator/language/scene.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

class StressGrid {
 public:
  // Compiles the integrator; an axis is h, scale or a run-time parameter.
  explicit StressGrid(const StressRequest& request);

  [[nodiscard]] const std::vector<StressAxis>& axes() const { return axes_; }
  [[nodiscard]] const PluginSource& plugin() const { return plugin_; }
  [[nodiscard]] const std::string& scene_name() const { return scene_name_; }
  [[nodiscard]] std::shared_ptr<const runtime::Library> library() const { return loaded_.library; }
  // What the compiler was asked for: "-O1".
  [[nodiscard]] const std::string& optimisation() const { return loaded_.optimisation; }

  // The scene with the axes' values in place of its own.  Throws ModelError where an expression of
  // the scene is not defined for them.
  [[nodiscard]] SceneValues scene_at(const std::vector<double>& at) const;
  // Throws ModelError likewise, and if H or its gradient is not defined at the initial state.
  [[nodiscard]] runtime::InitialValues start_at(const std::vector<double>& at) const;
  [[nodiscard]] const std::map<std::string, long>& sizes() const { return setting_.request.sizes; }

  // h omega of the fastest linear oscillation and its margin, see
  // generator/verify/linear_stability.hpp; empty where there is no oscillation, or the method is no
  // member with the same numbers for all degrees of freedom.
  struct Linear {
    double h_omega = 0.0;
    double margin = 0.0;
  };
  [[nodiscard]] std::optional<Linear> linear_at(const std::vector<double>& at);
  // Where the margin changes its sign along the second axis.
  [[nodiscard]] std::vector<std::array<double, 2>> linear_bound();

 private:
  Setting setting_;
  PluginSource plugin_;
  runtime::LoadedPlugin loaded_;
  std::string scene_name_;
  std::vector<StressAxis> axes_;
  std::map<std::vector<double>, std::optional<double>> omega_squared_;
};

}  // namespace hamgen::app
