// The plane of constant beta = b h, gamma = c h: how far the energy spreads in each cell.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "app/studies/stop.hpp"
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
                                   const MapAxis& c, double h, long steps, StopFlag stop,
                                   const std::function<void(std::size_t)>& on_progress);

}  // namespace hamgen::app
