// The matrix of the stages' simplified Newton iteration: 1 - coupling h b J H'', with the Hessian
// at the mean of the stages.
#pragma once

#include "generator/program/stage_parts.hpp"

namespace hamgen {

class StageMatrix : StageParts {
 public:
  explicit StageMatrix(const LoweredStep& lowered)
      : StageParts(lowered), second_order_(lowered.second_order) {}

  // Of its rows.
  [[nodiscard]] int size() const { return stages_ * (second_order_ ? n_ : dimension_); }

  // What Start has besides, if anything.
  [[nodiscard]] std::vector<Field> fields() const;
  [[nodiscard]] Routine differentiate() const;
  // start.lack becomes the increment of Newton's iteration.
  void add_elimination(RoutineBuilder& b, Body& body) const;

 private:
  [[nodiscard]] bool is_packed() const {
    return by_component() && (has_spare_room() || second_order_);
  }
  void add_blocks(RoutineBuilder& b, const Expression& weight, Body& each) const;
  void add_block_of_coordinates(RoutineBuilder& b, const Expression& weight, Body& each) const;

  const std::optional<SecondOrder>& second_order_;
};

}  // namespace hamgen
