// The beta, gamma plane as a table and as a picture.
#pragma once

#include <string>

#include "app/studies/tune_map.hpp"

namespace hamgen::app {

// Is there a colour for this spread: on a scale of logarithms?
[[nodiscard]] bool is_drawn(double spread);

// b, c and spread, one cell a row; an empty spread where the run failed.
[[nodiscard]] std::string map_csv(const EnergyMap& map, const std::string& header);
// A gnuplot script with its data that draws the logarithm of the spread, relative to the energy's
// scale if that is not 0, with marks at the midpoint rule, the fitted pair and the best cell, and
// lines where the linear part may become unbounded.
[[nodiscard]] std::string map_script(EnergyMap map, double scale, const std::string& title,
                                     const std::string& output);

}  // namespace hamgen::app
