// Numerical minimisation without derivatives.
#pragma once

#include <functional>
#include <vector>

#include "app/studies/stop.hpp"

namespace hamgen::app {

struct Polished {
  std::vector<double> coefficients;
  double value = 0.0;
  int evaluations = 0;
  bool ended = false;  // at a minimum, not at the limit of the evaluations
};

// Nelder and Mead's simplex method (NLopt) from `start`, whose k-th coefficient first moves by
// steps[k]; started anew from what it found until that gains nothing.  A function value that is not
// finite counts as very large.
[[nodiscard]] Polished polish(const std::function<double(const std::vector<double>&)>& function,
                              const std::vector<double>& start, const std::vector<double>& steps,
                              int most_evaluations, StopFlag stop);

}  // namespace hamgen::app
