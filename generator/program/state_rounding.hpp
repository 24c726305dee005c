// What the unknowns of an iteration are rounded with besides where forces cancel: see
// Note [forces that cancel] in mechanics/cancelling_forces.hpp.
#pragma once

#include <optional>
#include <vector>

#include "generator/program/lowered_step.hpp"
#include "generator/program/routine_builder.hpp"
#include "generator/program/step_weights.hpp"

namespace hamgen {

// Coordinates, and momenta where these are unknowns, else 0.
struct StateRounding {
  Expression q, p;
  Expression reach;

  // k.beside_q, k.beside_p, k.reach
  [[nodiscard]] std::vector<NamedWeight> coefficients() const;
  // start.beside, of so many components, and start.near
  void add_fields(Record& start, int components) const;
};

// Of a member's step in loops, whose momenta may be torn out.  None where there are no such forces,
// or where H is not p^2/2m + V(q) with one m.
[[nodiscard]] std::optional<StateRounding> loops_rounded_beside(const StepEquations& equations,
                                                                const StepWeights& weights,
                                                                bool torn);
// Of the stages of a Runge-Kutta method.
[[nodiscard]] std::optional<StateRounding> stages_rounded_beside(const LoweredStep& lowered);

// Elements of the state in a loop, each of them there so many times, and of start.beside.
struct StateElements {
  KernelRange each;
  Expression q, p;
  Expression beside_q, beside_p;
  int times = 1;
};
// start.beside = the state and these lengths, near zero.
void add_rounding(RoutineBuilder& b, const StateRounding& rounding, const StateElements& state);
// The length, for Refinement.
[[nodiscard]] Expression refined_length(RoutineBuilder& b);

}  // namespace hamgen
