// What `hamgen bench` measures as a picture: error against run time, a line a method.
#pragma once

#include <vector>

#include "app/output/plot.hpp"
#include "app/studies/bench.hpp"

namespace hamgen::app {

// By method: all of a few; of many those that are somewhere on a Pareto front, the most often
// first, the first of the list and baselines.
[[nodiscard]] std::vector<bool> methods_to_draw(const Bench& bench);
// Of one of the errors, with the level below which it is rounding: the error of the reference, or
// half a unit in the last place of a double of its size.
[[nodiscard]] PlotPanel bench_panel(const Bench& bench, Observed observed);
// Energy error and state error side by side.
[[nodiscard]] Plot bench_picture(const Bench& bench);

}  // namespace hamgen::app
