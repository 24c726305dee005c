#include "app/studies/angles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hamgen::app {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kPoints = 8;

// Point k of some that fill a box from -1 to 1: multiples of a number whose multiples are far
// apart.
double spread(int k, std::size_t component) {
  const double step = std::sqrt(2.0) + 0.61803398874989485 * static_cast<double>(component);
  return 2.0 * std::fmod((k + 1) * step, 1.0) - 1.0;
}

std::vector<runtime::Wide> point_around(const std::vector<runtime::Wide>& state,
                                        const std::vector<double>& sizes, int k) {
  std::vector<runtime::Wide> point = state;
  for (std::size_t i = 0; i < point.size(); ++i)
    point[i] = {state[i].hi + spread(k, i) * sizes[i], 0.0};
  return point;
}

}  // namespace

std::vector<bool> angles(const runtime::Library& library, const runtime::InitialValues& start,
                         const std::vector<double>& sizes) {
  const std::size_t n = start.state.size() / 2;
  std::vector<double> by_turn(n, 0.0);
  std::vector<double> by_part(n, 0.0);
  double largest = 0.0;
  for (int k = 0; k < kPoints; ++k) {
    const std::vector<runtime::Wide> here = point_around(start.state, sizes, k);
    const runtime::Wide energy = library.energy(start.parameters, here);
    largest = std::max(largest, std::abs(energy.hi));
    const auto changed_by = [&](std::size_t i, double change) {
      std::vector<runtime::Wide> there = here;
      there[i] = {here[i].hi + change, 0.0};
      const double difference =
          std::abs(runtime::difference(library.energy(start.parameters, there), energy));
      return std::isfinite(difference) ? difference : std::numeric_limits<double>::infinity();
    };
    for (std::size_t i = 0; i < n; ++i) {
      by_turn[i] = std::max(by_turn[i], changed_by(i, kTurn));
      by_part[i] = std::max(by_part[i], changed_by(i, 1.0));
    }
  }
  std::vector<bool> result;
  for (std::size_t i = 0; i < n; ++i) {
    const double seen = 1e-9 * by_part[i];
    result.push_back(std::isfinite(by_part[i]) && seen > 1e-15 * largest && by_turn[i] <= seen);
  }
  return result;
}

double within_a_turn(double angle) { return std::remainder(angle, kTurn); }

}  // namespace hamgen::app
