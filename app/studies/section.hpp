// Poincare sections: where orbits of one energy cross a surface.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/studies/setting.hpp"
#include "app/studies/stop.hpp"
#include "runtime/event.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

// What a scene observes for a section: the quantity that is zero on the surface, and the two that
// are its axes, under these names.
inline constexpr const char* kSurface = "surface";
inline constexpr const char* kFirstAxis = "axis_1";
inline constexpr const char* kSecondAxis = "axis_2";

struct SectionRequest {
  const PluginSource* plugin = nullptr;  // whose invariants are the three above
  std::shared_ptr<const runtime::Library> library;
  runtime::InitialValues start;  // of the scene
  runtime::Direction direction = runtime::Direction::rising;
  double energy = 0.0;
  std::vector<double> sizes = {};  // natural ones of the state's components; empty: all 1
  // Places in the state: of the variables of the axes, of the coordinate that is constant on the
  // surface with its value there, and of the momentum that gives the energy.
  std::size_t first = 0, second = 0, momentum = 0;
  std::optional<std::pair<std::size_t, double>> fixed = {};
  // The starts lie in this rectangle; empty: in that of the region around the scene's start that
  // the energy leaves.
  std::optional<std::array<double, 4>> box = {};  // first low, high, second low, high
  // Angles, of which only what is left of a turn counts: the surface, each axis.
  bool turns = false, first_turns = false, second_turns = false;
  int orbits = 0;   // 0: that of the scene alone
  long points = 0;  // of each orbit
  long steps = 0;   // of each orbit at most
  std::function<void(int done, int of)> on_progress = {};
  StopFlag stop = nullptr;
};

struct SectionPoint {
  double time = 0.0, first = 0.0, second = 0.0;
};

struct SectionOrbit {
  double first = 0.0, second = 0.0;  // where it starts
  runtime::Status status = runtime::Status::done;
  long steps = 0;
  double largest_error = 0.0;  // |H - H(start)| after a step
  double energy_scale = 0.0;   // see runtime::Judge::energy_terms
  std::vector<SectionPoint> points;
};

struct Section {
  std::vector<SectionOrbit> orbits;
  int tried = 0;        // starting points, of which
  int unreachable = 0;  // for these no momentum has the energy
};

// Throws UsageError where no starting point has the energy.
[[nodiscard]] Section section(const SectionRequest& request);

// The state with H = energy that its momentum at this place makes, on the side where the surface is
// crossed in the direction; empty if there is none.
[[nodiscard]] std::optional<std::vector<runtime::Wide>> with_energy(
    const SectionRequest& request, std::vector<runtime::Wide> state);

}  // namespace hamgen::app
