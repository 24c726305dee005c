// Which rows `hamgen bench --target` adds to those that were asked for.
#pragma once

#include <functional>

#include "app/studies/bench.hpp"

namespace hamgen::app {

struct Refinement {
  double target = 0.0;
  Rational time;        // of each run
  double finest = 0.0;  // no step below this
  // Fills in what was observed; false: go no further.
  std::function<bool(BenchRow&)> measure;
  std::function<void(double)> on_progress;  // the fraction that is done
};

// For each method that can be the quickest, the largest step that meets the target becomes a row;
// of a method that cannot meet it, the finest step that was tried.
void add_refined_rows(Bench& bench, const Refinement& refinement);

}  // namespace hamgen::app
