#include "generator/algebra/balance.hpp"

#include <cmath>

namespace hamgen {

namespace {

void scale(Eigen::MatrixXd& m, Eigen::Index i, int exponent) {
  m.col(i) *= std::ldexp(1.0, exponent);
  m.row(i) *= std::ldexp(1.0, -exponent);
}

}  // namespace

Beside beside_diagonal(const Eigen::MatrixXd& m, Eigen::Index i) {
  Beside sums;
  for (Eigen::Index k = 0; k < m.rows(); ++k) {
    if (k == i) continue;
    sums.column += std::abs(m(k, i));
    sums.row += std::abs(m(i, k));
  }
  return sums;
}

std::vector<int> balance(Eigen::MatrixXd m) {
  constexpr int kMostSweeps = 100;
  std::vector<int> exponents(static_cast<std::size_t>(m.rows()), 0);
  bool changed = m.allFinite();
  for (int sweep = 0; changed && sweep < kMostSweeps; ++sweep) {
    changed = false;
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      const Beside beside = beside_diagonal(m, i);
      if (!(beside.column > 0.0) || !(beside.row > 0.0)) continue;
      const double ratio = std::log2(beside.row) - std::log2(beside.column);
      const int exponent = static_cast<int>(std::lround(ratio / 2.0));
      // As much as LAPACK's gebal asks for a change to be worth it.
      if (std::ldexp(beside.column, exponent) + std::ldexp(beside.row, -exponent) >=
          0.95 * (beside.column + beside.row))
        continue;
      scale(m, i, exponent);
      exponents[static_cast<std::size_t>(i)] += exponent;
      changed = true;
    }
  }
  return exponents;
}

Eigen::MatrixXd balanced(Eigen::MatrixXd m) {
  const std::vector<int> exponents = balance(m);
  for (Eigen::Index i = 0; i < m.rows(); ++i) scale(m, i, exponents[static_cast<std::size_t>(i)]);
  return m;
}

}  // namespace hamgen
