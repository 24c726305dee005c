// The stages of the coordinates alone, for H = p^2/2m + V(q): with velocities that are linear in
// the momenta these can be eliminated, so that an iteration contracts as two of the whole do, at
// half the work.  It is a way to the solution of the stages' equations, which remain what they are.
#pragma once

#include "generator/program/stage_parts.hpp"

namespace hamgen {

class StageCoordinates : StageParts {
 public:
  // Only for a step that has them.
  StageCoordinates(const Environment& environment, const LoweredStep& lowered)
      : StageParts(lowered), environment_(environment), order_(*lowered.second_order) {}

  // What the iteration remembers: start.base.
  [[nodiscard]] Field base() const;
  // begin_coordinates, evaluate_coordinates, end_coordinates, eliminate_momenta, end_refinement
  [[nodiscard]] std::vector<Routine> routines() const;

 private:
  [[nodiscard]] Routine begin() const;
  [[nodiscard]] Routine evaluate() const;
  [[nodiscard]] Routine end() const;
  [[nodiscard]] Routine eliminate() const;
  [[nodiscard]] Routine end_refinement() const;
  // The mobility of coordinate j times that.
  Expression moved(RoutineBuilder& b, const Expression& momentum) const;

  const Environment& environment_;
  const SecondOrder& order_;
};

}  // namespace hamgen
