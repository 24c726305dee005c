#include "generator/verify/linear_modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "generator/verify/linear_eigenvalues.hpp"
#include "generator/verify/linear_step.hpp"
#include "generator/verify/rational_step.hpp"

namespace hamgen {

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool is_separable(const MatrixXd& s) {
  const Eigen::Index n = s.rows() / 2;
  return s.topRightCorner(n, n).isZero(0.0);
}

MatrixXd potential(const MatrixXd& s) { return s.topLeftCorner(s.rows() / 2, s.rows() / 2); }
MatrixXd kinetic(const MatrixXd& s) { return s.bottomRightCorner(s.rows() / 2, s.rows() / 2); }

Matrix2d plane(double v, double t) { return VectorXd{{v, t}}.asDiagonal(); }

// The eigenvalues of L^T V L with T = L L^T; empty if T is not positive definite.
std::optional<VectorXd> squared_frequencies(const MatrixXd& s) {
  const Eigen::LLT<MatrixXd> cholesky(kinetic(s));
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  const MatrixXd l = cholesky.matrixL();
  return VectorXd(Eigen::SelfAdjointEigenSolver<MatrixXd>(
                      MatrixXd(l.transpose() * potential(s) * l), Eigen::EigenvaluesOnly)
                      .eigenvalues());
}

// V and T in a common orthonormal basis, if they commute.
std::optional<std::vector<Matrix2d>> common_planes(const MatrixXd& s) {
  const MatrixXd v = potential(s);
  const MatrixXd t = kinetic(s);
  const double size = v.norm() * t.norm();
  if ((v * t - t * v).norm() > 1e-14 * size) return std::nullopt;
  // The basis of a combination whose weight no accident makes degenerate.
  const double weight = t.norm() > 0.0 ? 0.618034 * v.norm() / t.norm() : 0.0;
  const MatrixXd basis =
      Eigen::SelfAdjointEigenSolver<MatrixXd>(MatrixXd(v + weight * t)).eigenvectors();
  const MatrixXd v_there = basis.transpose() * v * basis;
  const MatrixXd t_there = basis.transpose() * t * basis;
  std::vector<Matrix2d> planes;
  for (Eigen::Index k = 0; k < v.rows(); ++k) planes.push_back(plane(v_there(k, k), t_there(k, k)));
  return planes;
}

// Is a frequency there more often than A^2 + w^2 has planes for it?  A double eigenvalue splits by
// the root of the rounding unit where that is so, and by the unit where not.  How many planes there
// are, a pivoted QR factorisation shows.
bool has_jordan_block(const MatrixXd& a, const std::vector<double>& frequencies) {
  constexpr double kSame = 1e-6;
  for (std::size_t first = 0; first < frequencies.size();) {
    std::size_t last = first + 1;
    const double w = frequencies[first];
    while (last < frequencies.size() && frequencies[last] - w <= kSame * w) ++last;
    const auto count = static_cast<Eigen::Index>(2 * (last - first));
    if (count > 2) {
      const MatrixXd square = a * a + w * w * MatrixXd::Identity(a.rows(), a.cols());
      const Eigen::ColPivHouseholderQR<MatrixXd> factors(square);
      const double zero = 10 * kSame * std::max(factors.maxPivot(), w * w);
      const auto sizes = factors.matrixQR().diagonal().array().abs();
      if ((sizes <= zero).count() < count) return true;
    }
    first = last;
  }
  return false;
}

}  // namespace

LinearSpectrum linear_spectrum(const MatrixXd& s) {
  const Eigen::Index n = s.rows() / 2;
  std::vector<std::complex<double>> squares;  // of eigenvalues
  double zero = 1e-13;  // relative to the largest; a symmetric problem has n rounding errors
  const auto positive = is_separable(s) ? squared_frequencies(s) : std::nullopt;
  if (positive) {
    for (const double square : *positive) squares.emplace_back(-square);
  } else {
    zero = 1e-10;
    const MatrixXd a = balanced(linear_flow(s));
    squares = eigenvalues(a * a);
    // Each is there twice.
    std::ranges::sort(squares, {}, [](const auto& x) { return std::pair(x.real(), x.imag()); });
    std::vector<std::complex<double>> half;
    for (std::size_t k = 0; k < squares.size(); k += 2) half.push_back(squares[k]);
    squares = std::move(half);
  }
  double largest = 0.0;
  for (const auto& square : squares) largest = std::max(largest, std::abs(square));
  zero *= static_cast<double>(n) * largest;
  LinearSpectrum spectrum{.largest = std::sqrt(largest)};
  for (const auto& square : squares) {
    if (std::abs(square) <= zero) {
      ++spectrum.free_motions;
    } else if (square.real() < 0.0 && std::abs(square.imag()) <= 1e-6 * std::abs(square)) {
      spectrum.frequencies.push_back(std::sqrt(-square.real()));
    } else {
      ++spectrum.growing;
      spectrum.growth_rate = std::max(spectrum.growth_rate, std::abs(std::sqrt(square).real()));
    }
  }
  std::ranges::sort(spectrum.frequencies);
  if (!positive)
    spectrum.resonant = has_jordan_block(balanced(linear_flow(s)), spectrum.frequencies);
  return spectrum;
}

// det(x - A) = p(x^2): the factors of p, each with its multiplicity m and its negative roots -w^2.
LinearSpectrum exact_spectrum(const ExactMatrix& s) {
  const ExactMatrix a = linear_flow(s);
  const ExactMatrix square = a * a;
  const RationalPolynomial of_a = characteristic_polynomial(a);
  RationalPolynomial p;
  for (std::size_t k = 0; k < of_a.size(); k += 2) p.push_back(of_a[k]);
  LinearSpectrum spectrum;
  while (!p.empty() && p.front() == 0) {
    ++spectrum.free_motions;
    p.erase(p.begin());
  }
  for (const auto& [factor, multiplicity] : square_free_factors(p)) {
    RationalPolynomial mirrored = factor;
    for (std::size_t k = 1; k < mirrored.size(); k += 2) mirrored[k] = -mirrored[k];
    const auto roots = positive_roots(mirrored);
    for (const auto& [low, high] : roots) {
      const double w = std::sqrt(to_double(Rational((low + high) / 2)));
      spectrum.frequencies.insert(spectrum.frequencies.end(),
                                  static_cast<std::size_t>(multiplicity), w);
    }
    spectrum.growing += multiplicity * (degree(factor) - static_cast<int>(roots.size()));
    const auto planes = static_cast<std::size_t>(2 * multiplicity * degree(factor));
    if (multiplicity > 1 && !roots.empty() && s.size - rank(value_at(factor, square)) < planes)
      spectrum.resonant = true;
  }
  std::ranges::sort(spectrum.frequencies);
  Eigen::MatrixXd rounded(s.size, s.size);
  for (std::size_t i = 0; i < s.size; ++i) {
    for (std::size_t j = 0; j < s.size; ++j)
      rounded(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = to_double(a(i, j));
  }
  for (const std::complex<double>& lambda : eigenvalues(rounded)) {
    spectrum.largest = std::max(spectrum.largest, std::abs(lambda));
    if (spectrum.growing > 0) spectrum.growth_rate = std::max(spectrum.growth_rate, lambda.real());
  }
  if (spectrum.growing == 0 && !spectrum.frequencies.empty())
    spectrum.largest = spectrum.frequencies.back();
  return spectrum;
}

std::optional<Scheme> scheme_of_one(const Scheme& scheme) {
  if (!scheme.has_member()) return scheme;
  const auto parameters = uniform_parameters(scheme.member());
  if (!parameters) return std::nullopt;
  Member member =
      family_member(1, {{parameters->alpha}}, {{parameters->beta}}, {{parameters->gamma}}).member();
  member.generating_order = scheme.member().generating_order;
  Scheme one = scheme;
  if (auto* composition = std::get_if<Composition>(&one.method)) {
    composition->base = std::move(member);
  } else {
    one.method = std::move(member);
  }
  return one;
}

std::optional<std::vector<Matrix2d>> linear_modes(const MatrixXd& s, const Scheme& scheme) {
  if (s.rows() == 2) return std::vector<Matrix2d>{s};
  std::vector<Matrix2d> planes;
  if (std::holds_alternative<RungeKutta>(scheme.method)) {
    for (const double w : linear_spectrum(s).frequencies) planes.push_back(plane(w * w, 1.0));
    return planes;
  }
  if (!is_separable(s) || !scheme_of_one(scheme)) return std::nullopt;
  if (scheme.has_member() && (has_beta(scheme.member()) || has_gamma(scheme.member())))
    return common_planes(s);
  const auto squares = squared_frequencies(s);
  if (!squares) return std::nullopt;
  for (const double square : *squares) planes.push_back(plane(square, 1.0));
  return planes;
}

}  // namespace hamgen
