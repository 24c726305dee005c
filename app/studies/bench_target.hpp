// The largest step with which a method meets an error bound, from the rows measured so far.
#pragma once

#include <optional>
#include <vector>

namespace hamgen::app {

struct StepSample {
  double h = 0.0;      // > 0
  double error = 0.0;  // infinite where the run failed
  double cost = 0.0;   // run time for a unit of time
};

struct StepSearch {
  std::vector<StepSample> samples;
  double order = 2.0;      // of the method
  double target = 0.0;     // the error bound
  double finest = 0.0;     // no step below this
  double best_cost = 0.0;  // of any method that meets the target; infinite if none does yet
  int interpolations = 0;  // tries between a step that meets the target and one that does not

  [[nodiscard]] const StepSample* smallest() const;  // null without samples
  // The largest sample that meets the target.
  [[nodiscard]] const StepSample* inside() const;
  // The next larger one, which does not; null without inside().
  [[nodiscard]] const StepSample* outside() const;
  [[nodiscard]] bool is_bracket() const { return inside() != nullptr && outside() != nullptr; }
  // What meeting the target should cost.
  [[nodiscard]] double expected_cost() const;
};

// The step to measure next: larger where all samples meet the target, smaller where none does, else
// between the two, by interpolation of the errors as powers of h or by bisection.  Empty where the
// largest sample is within a few per cent of the best step, where round-off is above the target,
// and where the method can no longer be the quickest.
[[nodiscard]] std::optional<double> next_step(const StepSearch& search);

// Errors of large steps are no powers of h, and may be small by chance: steps up to four times the
// one that meets the target, the largest first, with which the method would be the quickest.
[[nodiscard]] std::vector<double> larger_steps(const StepSearch& search);

}  // namespace hamgen::app
