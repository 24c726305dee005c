// The state errors of a stress map: what the states should be, as far as that can be known.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/studies/reference.hpp"
#include "app/studies/stress.hpp"
#include "app/studies/stress_grid.hpp"

namespace hamgen::app {

// Cells that differ only in the step or the method are on one orbit, at various times: one
// reference track an orbit, and an equal share of the time for each.
class StressReferences {
 public:
  // The cells that are undefined are marked so in the map.
  StressReferences(const StressGrid& grid, const StressMap& map, const StressLimits& limits);

  [[nodiscard]] std::size_t count() const { return orbits_.size(); }
  // The track of an orbit; of several orbits at a time.
  void compute(std::size_t orbit);
  // Fills the cell's state error, or why there is none.
  void compare(std::size_t cell, const std::vector<runtime::Wide>& start,
               const std::vector<runtime::Wide>& state, const PluginSource& plugin,
               StressCell& result) const;
  // What the references are, or why there are none.
  [[nodiscard]] const std::string& method() const { return method_; }

 private:
  struct Orbit {
    std::vector<double> place;  // axes that change the orbit
    SceneValues scene;
    std::vector<Rational> times;  // ascending
    ReferenceTrack track;
  };
  struct Place {
    std::size_t orbit = 0;
    Rational time;
  };

  StopFlag stop_;
  std::string method_;
  std::optional<ReferenceRule> rule_;
  double seconds_ = 0.0;  // an orbit
  std::vector<Orbit> orbits_;
  std::vector<Place> places_;  // of the cells
};

}  // namespace hamgen::app
