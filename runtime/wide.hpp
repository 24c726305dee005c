// Numbers wider than a double.
#pragma once

#include <cmath>
#include <compare>

namespace hamgen::runtime {

// hi + lo, where hi is the double nearest to the number: 106 bits, 32 decimal digits.  Of a double
// or a float lo is 0.
struct Wide {
  double hi = 0.0;  // the number, rounded to double
  double lo = 0.0;  // what rounding took from it
  friend bool operator==(const Wide&, const Wide&) = default;
  // Of the numbers: what is nearest does not change their order.
  friend std::partial_ordering operator<=>(const Wide&, const Wide&) = default;
};

// x - y, rounded to double: exact to a few 2^-53 of itself, or 2^-106 of the larger of the two.
[[nodiscard]] inline double difference(const Wide& x, const Wide& y) {
  const double hi = x.hi - y.hi;
  // What rounding left out of hi (Knuth's two-sum).
  const double part = hi - x.hi;
  const double rest = (x.hi - (hi - part)) + (-y.hi - part);
  return std::isfinite(hi) ? hi + (rest + (x.lo - y.lo)) : hi;
}

}  // namespace hamgen::runtime
