// What a compiled step does, measured beside what algebra proves of it.
#pragma once

#include <string>
#include <vector>

#include "app/studies/stop.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"

namespace hamgen::app {

// The largest change of an invariant along an orbit, looked at every ten steps.
struct InvariantDefect {
  std::string name;
  double initial = 0.0;
  double largest = 0.0;
  long steps = 0;
};
[[nodiscard]] Finding finding(const InvariantDefect& defect);

struct Measured {
  Proof proof;  // the tangent map
  std::vector<InvariantDefect> invariants;
};

// The tangent map of the compiled step around the scene, and along at most 10000 steps of the scene
// the change of every invariant.
[[nodiscard]] Measured measure(const SourceText& source, Request request,
                               const SceneRequest& wanted, bool symmetric, StopFlag stop);

}  // namespace hamgen::app
