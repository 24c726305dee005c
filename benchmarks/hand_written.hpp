// The implicit midpoint rule as one writes it for one problem when nothing but speed counts: the
// floor under every generated step.  It solves as exactly as the emitted code, with the same
// compensated sums, but knows beforehand what the emitted code measures as it runs: how many steps
// the extrapolation looks back, and below which increment Newton's iteration is at round-off.  It
// never fails: there is no domain to leave and no report.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "benchmarks/problems.hpp"

namespace hamgen::benchmarks {

// Weights of the polynomial through k values at 0..k-1, taken at k + 1: Lagrange's
// l_j = prod_(i != j) (k + 1 - i)/(j - i).  The value at k, the latest midpoint, is left out: then
// the derivatives at the start value need not wait for the end of the previous step.
template <std::size_t k>
constexpr std::array<double, k> extrapolation_weights() {
  std::array<double, k> weights = {};
  for (std::size_t j = 0; j < k; ++j) {
    double above = 1;
    double below = 1;
    for (std::size_t i = 0; i < k; ++i) {
      if (i == j) continue;
      above *= static_cast<double>(k + 1 - i);
      below *= static_cast<double>(j) - static_cast<double>(i);
    }
    weights[j] = above / below;
  }
  return weights;
}

template <class Problem>
class HandWritten {
 public:
  static constexpr const char* name = "hand-written";
  static constexpr int solves = 1;  // midpoint steps of size h/solves that a step is made of

  HandWritten(const Problem& problem, double h, const State<Problem>& z)
      : problem_(problem), h_(h), z_(z) {}

  bool advance(long long steps) {
    for (long long i = 0; i < steps; ++i) step();
    return true;
  }
  [[nodiscard]] const State<Problem>& state() const { return z_; }

 private:
  static constexpr std::size_t n = Problem::n;
  static constexpr std::size_t look_back = Problem::history;
  static constexpr std::size_t room = 256;

  // With q_bar the midpoint: R = q_bar - q - h/2 (p - h/2 V'(q_bar)), R' = 1 + h^2/4 V''(q_bar).
  // After the last increment d, Z = z + h J grad H at the midpoint, to first order in d.
  void step() {
    const double half = h_ / 2;
    const double quarter = half * half;
    Vector<n> q_bar;
    if (known_ <= look_back) {
      for (std::size_t i = 0; i < n; ++i) q_bar[i] = z_[i] + half * z_[n + i];
      ++known_;
    } else {
      extrapolate(q_bar, std::make_index_sequence<look_back>());
    }
    Vector<n> slope;
    Symmetric<n> hessian;
    Vector<n> d;
    while (true) {
      problem_.derivatives(q_bar, slope, hessian);
      Vector<n> residual;
      for (std::size_t i = 0; i < n; ++i) {
        residual[i] = (q_bar[i] - z_[i]) - half * z_[n + i] + quarter * slope[i];
      }
      double size = 0;
      if constexpr (n == 1) {
        d[0] = -residual[0] / (1 + quarter * hessian[0]);
        size = std::fabs(d[0]);
      } else {
        const double a = 1 + quarter * hessian[0];
        const double b = quarter * hessian[1];
        const double c = 1 + quarter * hessian[2];
        const double scale = 1 / (b * b - a * c);
        d[0] = scale * (c * residual[0] - b * residual[1]);
        d[1] = scale * (a * residual[1] - b * residual[0]);
        size = std::fabs(d[0]) + std::fabs(d[1]);
      }
      // The next increment is at most h^2/8 |V'''| size^2 < 3e-3 size^2.
      if (size < 1e-8) break;
      for (std::size_t i = 0; i < n; ++i) q_bar[i] += d[i];
    }
    if (used_ == room) {
      for (std::size_t j = 0; j <= look_back; ++j)
        midpoints_[j] = midpoints_[room - look_back - 1 + j];
      used_ = look_back + 1;
    }
    for (std::size_t i = 0; i < n; ++i) midpoints_[used_][i] = q_bar[i] + d[i];
    ++used_;
    if constexpr (n == 1) {
      slope[0] += hessian[0] * d[0];
    } else {
      slope[0] += hessian[0] * d[0] + hessian[1] * d[1];
      slope[1] += hessian[1] * d[0] + hessian[2] * d[1];
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double p_bar = z_[n + i] - half * slope[i];
      add(i, h_ * p_bar);
      add(n + i, -h_ * slope[i]);
    }
  }

  template <std::size_t... j>
  void extrapolate(Vector<n>& q_bar, std::index_sequence<j...>) const {
    constexpr std::array<double, look_back> weights = extrapolation_weights<look_back>();
    const Vector<n>* oldest = &midpoints_[used_ - 1 - look_back];
    for (std::size_t i = 0; i < n; ++i) q_bar[i] = (... + (weights[j] * oldest[j][i]));
  }

  // Compensated sum: two-sum of Knuth.
  void add(std::size_t i, double increment) {
    const double wanted = increment + carry_[i];
    const double sum = z_[i] + wanted;
    const double part = sum - z_[i];
    carry_[i] = (z_[i] - (sum - part)) + (wanted - part);
    z_[i] = sum;
  }

  Problem problem_;
  double h_;
  State<Problem> z_;
  State<Problem> carry_ = {};
  std::array<Vector<n>, room> midpoints_ = {};
  std::size_t used_ = 0;
  std::size_t known_ = 0;
};

}  // namespace hamgen::benchmarks
