// When a run ends before its steps are done.
#pragma once

#include <string>

#include "generator/language/model.hpp"

namespace hamgen {

struct EndCondition {
  ModelEvent event;    // where a value crosses zero,
  bool holds = false;  // or else: after the first step where it is positive
  // |H - H(0)| times this is added to the value: 1, -1, or 0.
  int energy_error = 0;
};

// EXPR [rising|falling], A > B, A < B, or the name of one of the model's events; energy_error
// stands alone on one side of a comparison.  Throws UsageError showing the place in the text.
[[nodiscard]] EndCondition read_end_condition(const Model& model, const std::string& option,
                                              const std::string& text);

}  // namespace hamgen
