// The steps with which a method is worth a row where none are given.
#pragma once

#include <functional>

#include "app/studies/bench.hpp"

namespace hamgen::app {

inline constexpr long kMostBenchSteps = 100'000'000;  // of a run

// Not measured yet.  h is changed a little where it does not divide the time, so that every row
// ends at the same time.  Throws UsageError where it makes too many steps.
[[nodiscard]] BenchRow row_of(std::size_t method, const Rational& time, const Rational& h);

struct RangeSearch {
  Rational h;     // to begin with
  Rational time;  // of each run
  // Fills in what was observed; false: go no further.
  std::function<bool(BenchRow&)> measure;
};

// Rows of h 2^k whose errors lie between 1e-2 and the rounding floor of the method, the largest
// step first.  The floor is the largest step whose error neither half nor a quarter of it makes
// four times smaller, of order 1 twice; one row at most is beyond it.  No step is below h/64.  A
// method that fails, or is worse than 1e-2, with all of them has one row.
void add_rows_in_range(Bench& bench, std::size_t method, const RangeSearch& search);

}  // namespace hamgen::app
