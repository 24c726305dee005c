// What a step conserves instead of H: its modified Hamiltonian, watched.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/studies/stop.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"

namespace hamgen::app {

// How constant Ht is along a numerical orbit.
struct WatchedOrbit {
  std::string scene;
  double h = 0.0;
  long steps = 0;
  std::vector<double> variations;  // max |Ht - Ht(0)|, by the power of h that Ht goes to
};

struct ModifiedEnergy {
  std::vector<Expression> terms;  // of Ht, by the power of h
  std::optional<WatchedOrbit> orbit;

  // Those with a term, and 0.
  [[nodiscard]] std::vector<std::size_t> powers() const;
};

// The orbit of the scene in quad precision: what is left of the variation is that of the step, not
// of rounding.  `terms` are those of modified_hamiltonian.
[[nodiscard]] WatchedOrbit watch_orbit(const SourceText& source, Request request,
                                       const SceneValues& scene,
                                       const std::vector<Expression>& terms, StopFlag stop);

}  // namespace hamgen::app
