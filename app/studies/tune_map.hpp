// The plane of constant beta = b h, gamma = c h: how far the energy spreads in each cell.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/tune_measure.hpp"

namespace hamgen::app {

struct MapAxis {
  double low = 0.0;
  double high = 0.0;
  int count = 0;
  [[nodiscard]] double at(int i) const { return low + (high - low) * i / (count - 1); }
};

struct MapPoint {
  double b = 0.0;
  double c = 0.0;
};

struct EnergyMap {
  MapAxis b, c;
  std::vector<double> spread;  // row by row, b fastest; nan where the run failed
  std::size_t done = 0;        // cells, fewer than all after an interrupt
  MapPoint fitted = {};        // the pair of least squares
  // The linear part is sure to stay bounded for b above and c below these, where they are known.
  std::optional<double> lowest_b = {};
  std::optional<double> highest_c = {};
};

// In parallel, one thread a processor.  on_progress gets the cells done, from the caller's thread.
[[nodiscard]] EnergyMap energy_map(const GaugedIntegrator& integrator, const MapAxis& b,
                                   const MapAxis& c, double h, long steps,
                                   const std::function<void(std::size_t)>& on_progress);

// Is there a colour for this spread: on a scale of logarithms?
[[nodiscard]] bool is_drawn(double spread);

// b, c and spread, one cell a row; an empty spread where the run failed.
[[nodiscard]] std::string map_csv(const EnergyMap& map, const std::string& header);
// A gnuplot script with its data that draws the logarithm of the spread, with marks at the midpoint
// rule, the fitted pair and the best cell, and lines where the linear part may become unbounded.
[[nodiscard]] std::string map_script(const EnergyMap& map, const std::string& title,
                                     const std::string& output);

}  // namespace hamgen::app
