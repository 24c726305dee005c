// Which combination of functions makes another one constant.
#pragma once

#include <cstddef>
#include <vector>

namespace hamgen::runtime {

struct Flattening {
  std::vector<double> coefficients;  // 0 for a function that is not needed
  std::size_t rank = 0;              // how many functions were used: independent, not constant
  double spread_before = 0.0;        // max - min of the target
  double spread_after = 0.0;         // and of target + sum of coefficient * function
  double deviation_before = 0.0;     // root mean square distance from the mean, likewise
  double deviation_after = 0.0;
};

// The coefficients x that minimise the variance of target + sum_k x_k functions[k] over samples;
// functions[k] has as many samples as the target.  Long double, modified Gram-Schmidt on what is
// left of the functions without their means, the largest first.  Throws std::invalid_argument where
// the sizes differ or there are no samples.
[[nodiscard]] Flattening flatten(const std::vector<double>& target,
                                 const std::vector<std::vector<double>>& functions);

}  // namespace hamgen::runtime
