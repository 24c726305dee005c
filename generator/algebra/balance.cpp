#include "generator/algebra/balance.hpp"

#include <algorithm>
#include <cmath>

namespace hamgen {

namespace {

using Rows = std::vector<std::vector<double>>;

// The sums of the absolute values of column and row i without the diagonal.
std::pair<double, double> beside_diagonal(const Rows& m, std::size_t i) {
  double column = 0.0;
  double row = 0.0;
  for (std::size_t k = 0; k < m.size(); ++k) {
    if (k == i) continue;
    column += std::abs(m[k][i]);
    row += std::abs(m[i][k]);
  }
  return {column, row};
}

bool is_finite(const Rows& m) {
  return std::ranges::all_of(m, [](const auto& row) {
    return std::ranges::all_of(row, [](double x) { return std::isfinite(x); });
  });
}

}  // namespace

std::vector<int> balance(Rows m) {
  constexpr int kMostSweeps = 100;
  std::vector<int> exponents(m.size(), 0);
  bool changed = is_finite(m);
  for (int sweep = 0; changed && sweep < kMostSweeps; ++sweep) {
    changed = false;
    for (std::size_t i = 0; i < m.size(); ++i) {
      const auto [column, row] = beside_diagonal(m, i);
      if (!(column > 0.0) || !(row > 0.0)) continue;
      const double ratio = std::log2(row) - std::log2(column);
      const int exponent = static_cast<int>(std::lround(ratio / 2.0));
      // As much as LAPACK's gebal asks for a change to be worth it.
      if (std::ldexp(column, exponent) + std::ldexp(row, -exponent) >= 0.95 * (column + row))
        continue;
      for (std::size_t k = 0; k < m.size(); ++k) {
        m[k][i] = std::ldexp(m[k][i], exponent);
        m[i][k] = std::ldexp(m[i][k], -exponent);
      }
      exponents[i] += exponent;
      changed = true;
    }
  }
  return exponents;
}

}  // namespace hamgen
