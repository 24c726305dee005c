// The matrix of the stages' simplified Newton iteration: 1 - coupling h b J H'', with the Hessian
// at the mean of the stages.
#pragma once

#include "generator/program/stage_parts.hpp"

namespace hamgen {

class StageMatrix : StageParts {
 public:
  explicit StageMatrix(const LoweredStep& lowered) : StageParts(lowered) {}

  // What Start has besides, if anything.
  [[nodiscard]] std::vector<Field> fields() const;
  [[nodiscard]] Routine differentiate() const;
  // start.lack becomes the increment of Newton's iteration.
  void add_elimination(RoutineBuilder& b, Body& body) const;
};

}  // namespace hamgen
