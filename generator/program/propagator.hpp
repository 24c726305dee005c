// Many steps: what a run keeps from one to the next, and the routines that change it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "generator/program/program.hpp"

namespace hamgen {

// What a field is in a new Propagator: the argument `from`, or what a routine makes of `par` and
// it.
struct Beginning {
  std::string field;
  std::string record = {};  // its type; empty: a number
  std::string from;
  std::string routine = {};
};

// What may be read of a Propagator.
struct Accessor {
  std::string name;
  std::string type;            // "State", "Real"
  std::optional<Place> place;  // none: the time, which is the steps times h
  std::vector<std::string> remark = {};
};

// Fields of `record` are the numbers and records of "self"; those with a size have one for each
// substep of a composition.
struct Propagator {
  std::vector<std::string> remark = {};
  Record record;
  std::vector<std::pair<std::string, int>> constants = {};  // "substeps" of a composition, ...
  // Of the arguments par, h and z.  Those of each substep follow its length, which they are made
  // of.
  std::vector<Beginning> beginnings = {};
  std::vector<Beginning> substep_beginnings = {};
  std::vector<Rational> fractions = {};  // of h, the lengths of the substeps of a composition
  std::vector<Routine> routines;         // "substep" of a composition, "step", "advance", "reset"
  std::vector<Accessor> accessors = {};
};

[[nodiscard]] Propagator propagator_of(const Program& code);
// Of so many trajectories side by side, each as if it were alone: "self.running" are those that go
// on.
[[nodiscard]] Propagator lane_propagator_of(const Program& code, int lanes);

// One step alone, of a method whose step is one solve of little room: nothing is kept.
[[nodiscard]] Routine single_step(const Program& code);
// What the report of a step consists of.
[[nodiscard]] const Record& step_report();

}  // namespace hamgen
