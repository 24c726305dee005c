// What an emitted file has of a step, piece by piece in its order: languages print it, and a file
// that is read back is compared with it.
#pragma once

#include <variant>
#include <vector>

#include "generator/program/propagator.hpp"

namespace hamgen {

// The function step by a Propagator of one step.
struct StepOfPropagator {};
// What finds events along the steps.
struct Watch {
  std::vector<EventName> events;
};
using Piece = std::variant<Record, Routine, ArrayMatrix, Propagator, StepOfPropagator, Watch>;

struct Contents {
  std::vector<Piece> system;  // equal for all of its methods
  std::vector<Piece> method;
};

struct ContentsWishes {
  // Has the method a namespace of its own, where it adds to the parameters of the system what only
  // it takes?
  bool own_space = true;
  bool tangent = false;  // the linearised step too
  int lanes = 0;         // trajectories side by side
};
[[nodiscard]] Contents contents_of(const Program& program, const ContentsWishes& wishes);

// The parameter that only the method takes, if it has a namespace of its own and there is one.
[[nodiscard]] const Field* parameter_of_method(const Contents& contents);

}  // namespace hamgen
