// Reference solutions: what the state of a scene is at a time, to far more digits than a double
// has.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::app {

struct ReferenceRequest {
  std::map<std::string, long> sizes;
  std::vector<std::string> fold;
  std::string compiler;                          // empty: the default
  std::function<void(double)> on_progress = {};  // the fraction that is done
};

struct ReferenceSolution {
  std::vector<runtime::Wide> state;  // q then p; empty if there is none
  double error = 0.0;                // largest difference of a component between two tolerances
  bool from_cache = false;
  double seconds = 0.0;
  std::string failure;  // why there is none
};

// The state at `time`: a symmetric rule of order 2 for the same model in quad numbers, extrapolated
// with two tolerances; the difference of the two is the error.  Kept in hamgen's cache under a hash
// of the emitted text, the parameters, the initial state and the time.
[[nodiscard]] ReferenceSolution reference_solution(const SourceText& source,
                                                   const SceneValues& scene, const Rational& time,
                                                   const ReferenceRequest& request);

// The states at interval, 2 interval, ..., count interval, of the finer tolerance alone; fewer
// where the solution ends.  Cached alike.
[[nodiscard]] std::vector<std::vector<runtime::Wide>> reference_track(
    const SourceText& source, const SceneValues& scene, const Rational& interval, int count,
    const ReferenceRequest& request);

}  // namespace hamgen::app
