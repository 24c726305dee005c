// Pictures of a number over a plane.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hamgen::app {

struct HeatMap {
  std::string title, x_label, y_label, value_label;
  std::vector<double> x, y;                   // ascending, evenly spaced
  std::vector<std::optional<double>> values;  // row by row of y; empty: grey
  double low = 0.0, high = 1.0;               // the ends of the colours
};

// A gnuplot script with its data; the ending of the path of the picture chooses svg or png.
[[nodiscard]] std::string heat_map_script(const HeatMap& map, const std::string& output);

}  // namespace hamgen::app
