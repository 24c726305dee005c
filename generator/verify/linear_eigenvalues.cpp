#include "generator/verify/linear_eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "generator/algebra/balance.hpp"

namespace hamgen {

namespace {

Eigen::MatrixXd without(const Eigen::MatrixXd& m, Eigen::Index i) {
  std::vector<Eigen::Index> others;
  for (Eigen::Index k = 0; k < m.rows(); ++k)
    if (k != i) others.push_back(k);
  return m(others, others);
}

// Is one of the elements besides that one not 0?
template <class Line>
bool has_other(const Line& line, Eigen::Index one) {
  for (Eigen::Index k = 0; k < line.size(); ++k)
    if (k != one && line(k) != 0.0) return true;
  return false;
}

}  // namespace

Eigen::MatrixXd balanced(Eigen::MatrixXd m) {
  std::vector<std::vector<double>> rows;
  for (const auto& row : m.rowwise()) rows.emplace_back(row.begin(), row.end());
  const std::vector<int> exponents = balance(std::move(rows));
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    const int exponent = exponents[static_cast<std::size_t>(i)];
    m.col(i) *= std::ldexp(1.0, exponent);
    m.row(i) *= std::ldexp(1.0, -exponent);
  }
  return m;
}

std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd& matrix) {
  Eigen::MatrixXd rest = matrix;
  std::vector<std::complex<double>> found;
  // Where a column or a row is empty beside the diagonal, its element there is an eigenvalue, and
  // what stands in the other one, of whatever size, touches none.
  for (Eigen::Index i = 0; i < rest.rows();) {
    if (has_other(rest.col(i), i) && has_other(rest.row(i), i)) {
      ++i;
      continue;
    }
    found.emplace_back(rest(i, i));
    rest = without(rest, i);
    i = 0;
  }
  if (rest.rows() == 0) return found;
  const Eigen::VectorXcd values =
      Eigen::EigenSolver<Eigen::MatrixXd>(balanced(std::move(rest)), false).eigenvalues();
  found.insert(found.end(), values.begin(), values.end());
  return found;
}

double spectral_radius(const Eigen::MatrixXd& matrix) {
  double largest = 0.0;
  for (const std::complex<double>& value : eigenvalues(matrix))
    largest = std::max(largest, std::abs(value));
  return largest;
}

double margin_of(const Eigen::MatrixXd& m, bool symplectic) {
  if (!m.allFinite()) return -1.0;
  if (symplectic) {
    // det M = 1: the eigenvalues have modulus 1 and are two iff |trace| < 2, that is
    // det(M + I) = 2 + trace > 0 and det(M - I) = 2 - trace > 0, the latter small for a small h.
    const double diagonal = (m(0, 0) - 1.0) * (m(1, 1) - 1.0);
    const double across = m(0, 1) * m(1, 0);
    const double size = std::abs(diagonal) + std::abs(across);
    return std::min(1.0 + 0.5 * m.trace(), size > 0.0 ? (diagonal - across) / size : 0.0);
  }
  return 1.0 - spectral_radius(m);
}

double margin_together(const Eigen::MatrixXd& matrix, int free_motions) {
  const Eigen::MatrixXd m = balanced(matrix);
  if (!m.allFinite()) return -1.0;
  const Eigen::MatrixXd sum = m + m.inverse();
  if (!sum.allFinite()) return -1.0;
  // In rounded numbers two that meet and two that have left the axis look alike: both are a border.
  std::vector<std::complex<double>> pairs = eigenvalues(sum);
  std::ranges::sort(pairs, {}, [](const auto& x) { return x.real(); });
  std::vector<double> margins;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double across = std::abs(pairs[k].imag());
    double margin = 1.0 - std::abs(pairs[k].real()) / 2.0;
    if (across > 1e-6 * (1.0 + std::abs(pairs[k]))) margin = -across;
    const std::size_t next = k - k % 2 + 2;
    if (margin > 0.0 && next < pairs.size() && std::abs(pairs[next] - pairs[k]) < 1e-5)
      margin = 0.0;
    margins.push_back(margin);
  }
  std::ranges::sort(margins, {}, [](double x) { return std::abs(x); });
  const auto skipped = static_cast<std::ptrdiff_t>(2 * free_motions);
  return *std::min_element(margins.begin() + skipped, margins.end());
}

}  // namespace hamgen
