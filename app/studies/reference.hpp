// Reference solutions: what the state of a scene is at a time, to far more digits than a double
// has.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/studies/load_integrator.hpp"
#include "app/studies/stop.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"
#include "runtime/integrator.hpp"
#include "runtime/load_plugin.hpp"

namespace hamgen::app {

struct ReferenceRequest {
  std::map<std::string, long> sizes;
  std::vector<std::string> fold;
  CompilerChoice compiler;
  StopFlag stop = nullptr;
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

// What references extrapolate: a symmetric rule of order 2 for the same model in quad numbers.
struct ReferenceRule {
  PluginSource plugin;
  runtime::LoadedPlugin loaded;
};
// Throws ToolError where the compiler fails: quad numbers may be more than it can do.
[[nodiscard]] ReferenceRule reference_rule(const SourceText& source,
                                           const ReferenceRequest& request);

// The states at some times, each with the largest difference between two tolerances.
struct ReferenceTrack {
  std::vector<std::vector<runtime::Wide>> states;  // at the first of the times: all, or fewer
  std::vector<double> errors;
  std::string missing;  // why the other times have none; empty if there are all
};

// Times ascend in absolute value, from 0 in one direction.  After `seconds` of the
// thread's processor time the rest is missing.
// Cached like a reference solution.
[[nodiscard]] ReferenceTrack reference_track(const ReferenceRule& rule,
                                             const runtime::InitialValues& start,
                                             const std::vector<Rational>& times, double seconds,
                                             StopFlag stop);

// Euclidean.
[[nodiscard]] double distance(const std::vector<runtime::Wide>& x,
                              const std::vector<runtime::Wide>& y);

}  // namespace hamgen::app
