#include "app/studies/stress_references.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studies/initial_data.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

// The orbit does not depend on how it is computed.
bool changes_orbit(const std::string& axis) {
  return axis != "h" && axis != "alpha" && axis != "beta" && axis != "gamma";
}

double length(const std::vector<runtime::Wide>& x) {
  return distance(x, std::vector<runtime::Wide>(x.size()));
}

}  // namespace

StressReferences::StressReferences(const StressGrid& grid, const StressMap& map,
                                   const StressLimits& limits)
    : stop_(limits.stop) {
  if (!(limits.reference_time.count() > 0.0)) {
    method_ = "not asked for";
    return;
  }
  try {
    rule_ =
        reference_rule(grid.plugin().model.source, {.sizes = grid.sizes(), .stop = limits.stop});
  } catch (const runtime::ToolError& error) {
    method_ = "none: " + error.failure().message;
    return;
  }
  method_ = "against a reference extrapolated in quad precision";
  for (std::size_t cell = 0; cell < map.cells.size(); ++cell) {
    if (map.cells[cell].outcome == runtime::Status::undefined) {
      places_.emplace_back();
      continue;
    }
    const std::vector<double> at = map.place(cell);
    std::vector<double> place;
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (changes_orbit(map.axes[i].label)) place.push_back(at[i]);
    }
    auto orbit = std::ranges::find(orbits_, place, &Orbit::place);
    const SceneValues scene = grid.scene_at(at);
    if (orbit == orbits_.end()) {
      orbits_.push_back({.place = place, .scene = scene});
      orbit = orbits_.end() - 1;
    }
    places_.push_back({.orbit = static_cast<std::size_t>(orbit - orbits_.begin()),
                       .time = *scene.h * limits.steps});
    orbit->times.push_back(places_.back().time);
  }
  for (Orbit& orbit : orbits_) {
    std::ranges::sort(orbit.times, {}, [](const Rational& time) { return Rational(abs(time)); });
    const auto rest = std::ranges::unique(orbit.times);
    orbit.times.erase(rest.begin(), rest.end());
  }
  // On two threads.
  seconds_ = 2.0 * limits.reference_time.count() / static_cast<double>(orbits_.size());
}

void StressReferences::compute(std::size_t i) {
  Orbit& orbit = orbits_[i];
  try {
    const auto start = initial_values(rule_->plugin, orbit.scene, *rule_->loaded.library);
    orbit.track = reference_track(*rule_, start, orbit.times, seconds_, stop_);
  } catch (const ModelError&) {
    orbit.track.missing = "H is not defined at the initial state";
  }
}

void StressReferences::compare(std::size_t cell, const std::vector<runtime::Wide>& start,
                               const std::vector<runtime::Wide>& state, const PluginSource& plugin,
                               StressCell& result) const {
  if (result.outcome != runtime::Status::done && result.outcome != runtime::Status::jumped) {
    result.state_missing = runtime::to_text(result.outcome);
    return;
  }
  if (!rule_) {
    result.state_missing = "references are " + method_;
    return;
  }
  const Place& place = places_[cell];
  const Orbit& orbit = orbits_[place.orbit];
  const ReferenceTrack& track = orbit.track;
  const auto at =
      static_cast<std::size_t>(std::ranges::find(orbit.times, place.time) - orbit.times.begin());
  if (at >= track.states.size()) {
    result.state_missing = track.missing;
    return;
  }
  const std::vector<runtime::Wide> exact = kept_state(plugin, track.states[at]);
  const double error = distance(state, exact);
  result.state_scale = std::max(length(start), length(exact));
  // A reference that is wrong in the last digit of the error, or of a double, still serves.
  constexpr double rounding = 1e-16;
  const double own = track.errors[at];
  if (!(own <= std::max(0.01 * error, rounding * result.state_scale))) {
    result.state_missing = fmt::format("the reference is known to {:.1e} only", own);
    return;
  }
  if (std::isfinite(error)) {
    result.state_error = error;
  } else {
    result.state_missing = runtime::to_text(runtime::Status::overflow);
  }
}

}  // namespace hamgen::app
