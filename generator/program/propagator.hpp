// Many steps: what a run keeps from one to the next, and the routines that change it.
#pragma once

#include <vector>

#include "generator/program/program.hpp"

namespace hamgen {

// Fields of `record` are the numbers and records of "self"; those with a size have one for each
// substep of a composition.
struct Propagator {
  Record record;
  std::vector<Routine> routines;  // "substep" of a composition, "step", "advance", "reset"
};

[[nodiscard]] Propagator propagator_of(const Program& code);
// Of trajectories side by side, each as if it were alone: "self.running" are those that go on.
[[nodiscard]] Propagator lane_propagator_of(const Program& code);

// One step alone, of a method whose step is one solve of little room: nothing is kept.
[[nodiscard]] Routine single_step(const Program& code);
// What the report of a step consists of.
[[nodiscard]] const Record& step_report();

}  // namespace hamgen
