// Steps by hand, for one problem each, when nothing but speed counts: implicit midpoint for
// H = sum m_i p_i^2/2 + V(q), by a fixed point from an extrapolated start, with constants tuned to
// the problem, no compensated sums and no report.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hamgen::cost_table {

// Problem: n, inverse mass(i), force(q, f) with f = V'(q), `look_back` values of the extrapolation,
// `iterations` of the fixed point.
template <class Problem>
class HandMidpoint {
 public:
  HandMidpoint(const Problem& problem, double h, const std::vector<double>& z)
      : problem_(problem), h_(h) {
    for (std::size_t i = 0; i < n; ++i) {
      q_[i] = z[i];
      p_[i] = z[n + i];
    }
  }
  void advance(long steps) {
    for (long s = 0; s < steps; ++s) step();
  }
  [[nodiscard]] double coordinate(std::size_t i) const { return q_[i]; }

 private:
  static constexpr std::size_t n = Problem::n;
  static constexpr std::size_t room = Problem::look_back;
  using Vector = std::array<double, n>;

  // Weights of the polynomial of degree room - 1 through the last values, at the next one.
  static constexpr std::array<double, room> weights() {
    std::array<double, room> w = {};
    double binomial = 1;
    for (std::size_t j = 0; j < room; ++j) {
      binomial = binomial * static_cast<double>(room - j) / static_cast<double>(j + 1);
      w[j] = j % 2 == 0 ? binomial : -binomial;
    }
    return w;
  }
  void predict(Vector& bar) const {
    constexpr std::array<double, room> w = weights();
    std::array<const double*, room> past;
    for (std::size_t j = 0; j < room; ++j) past[j] = past_[(newest_ + room - j) % room].data();
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < room; ++j) sum += w[j] * past[j][i];
      bar[i] = sum;
    }
  }
  void step() {
    const double half = h_ / 2;
    Vector bar;
    Vector force;
    if (known_ < room) {
      for (std::size_t i = 0; i < n; ++i) bar[i] = q_[i] + half * problem_.inverse_mass(i) * p_[i];
    } else {
      predict(bar);
    }
    // The coordinates first: the last force serves the momenta too.
    for (int k = known_ < room ? 40 : Problem::iterations;; --k) {
      problem_.force(bar.data(), force.data());
      if (k == 0) break;
      for (std::size_t i = 0; i < n; ++i) {
        bar[i] = q_[i] + half * problem_.inverse_mass(i) * (p_[i] - half * force[i]);
      }
    }
    newest_ = (newest_ + 1) % room;
    known_ += known_ < room ? 1 : 0;
    past_[newest_] = bar;
    for (std::size_t i = 0; i < n; ++i) {
      const double momentum = p_[i] - half * force[i];
      q_[i] += h_ * problem_.inverse_mass(i) * momentum;
      p_[i] -= h_ * force[i];
    }
  }

  Problem problem_;
  double h_;
  Vector q_, p_;
  std::array<Vector, room> past_ = {};
  std::size_t newest_ = 0;
  std::size_t known_ = 0;
};

// V = sum over the bonds r of r^2/2 + alpha r^3/3, both ends held.
template <std::size_t size>
struct HandFput {
  static constexpr std::size_t n = size;
  static constexpr std::size_t look_back = 6;
  static constexpr int iterations = 1;
  double alpha = 0.25;

  static double inverse_mass(std::size_t) { return 1; }
  void force(const double* __restrict q, double* __restrict f) const {
    const auto bond = [this](double r) { return r + alpha * (r * r); };
    f[0] = bond(q[0]) - bond(q[1] - q[0]);
    for (std::size_t i = 1; i + 1 < n; ++i) f[i] = bond(q[i] - q[i - 1]) - bond(q[i + 1] - q[i]);
    f[n - 1] = bond(q[n - 1] - q[n - 2]) - bond(-q[n - 1]);
  }
};

// Kick, drift, kick of the same chain with compensated sums, the last kick's force kept.
template <std::size_t n>
class HandVerlet {
 public:
  HandVerlet(double alpha, double h, const std::vector<double>& z) : chain_{alpha}, h_(h) {
    for (std::size_t i = 0; i < n; ++i) {
      q_[i] = z[i];
      p_[i] = z[n + i];
    }
    chain_.force(q_.data(), force_.data());
  }
  void advance(long steps) {
    for (long s = 0; s < steps; ++s) step();
  }
  [[nodiscard]] double coordinate(std::size_t i) const { return q_[i]; }

 private:
  using Vector = std::array<double, n>;
  static void add(double& value, double& carry, double increment) {
    const double whole = increment + carry;
    const double sum = value + whole;
    const double part = sum - value;
    carry = (value - (sum - part)) + (whole - part);
    value = sum;
  }
  void step() {
    const double half = h_ / 2;
    for (std::size_t i = 0; i < n; ++i) {
      add(p_[i], p_carry_[i], -half * force_[i]);
      add(q_[i], q_carry_[i], h_ * p_[i]);
    }
    chain_.force(q_.data(), force_.data());
    for (std::size_t i = 0; i < n; ++i) add(p_[i], p_carry_[i], -half * force_[i]);
  }

  HandFput<n> chain_;
  double h_;
  Vector q_, p_, force_ = {}, q_carry_ = {}, p_carry_ = {};
};

// Soft springs with V = r^4/4 between stiff ones, m of them: x, then y.
struct HandStiffFpu {
  static constexpr std::size_t m = 3;
  static constexpr std::size_t n = 2 * m;
  static constexpr std::size_t look_back = 7;
  static constexpr int iterations = 2;
  double w = 300;

  static double inverse_mass(std::size_t) { return 1; }
  void force(const double* __restrict q, double* __restrict f) const {
    std::array<double, m + 1> soft;
    for (std::size_t i = 0; i <= m; ++i) {
      const double left = i == 0 ? 0 : q[i - 1] + q[m + i - 1];
      const double right = i == m ? 0 : q[i] - q[m + i];
      const double r = right - left;
      soft[i] = r * r * r;
    }
    for (std::size_t i = 0; i < m; ++i) {
      f[i] = soft[i] - soft[i + 1];
      f[m + i] = w * w * q[m + i] - soft[i] - soft[i + 1];
    }
  }
};

// V = - sum over pairs of strength mass_i mass_j / sqrt(r^2 + softening): x, then y, then z.
template <std::size_t bodies, std::size_t history, int count>
struct HandBodies {
  static constexpr std::size_t n = 3 * bodies;
  static constexpr std::size_t look_back = history;
  static constexpr int iterations = count;
  std::array<double, bodies> mass = {};
  double strength = 1;
  double softening = 0;

  [[nodiscard]] double inverse_mass(std::size_t i) const { return 1 / mass[i % bodies]; }
  void force(const double* __restrict q, double* __restrict f) const {
    for (std::size_t i = 0; i < n; ++i) f[i] = 0;
    const double* x = q;
    const double* y = q + bodies;
    const double* z = q + 2 * bodies;
    for (std::size_t i = 1; i < bodies; ++i) {
      double fx = 0;
      double fy = 0;
      double fz = 0;
      for (std::size_t j = 0; j < i; ++j) {
        const double dx = x[i] - x[j];
        const double dy = y[i] - y[j];
        const double dz = z[i] - z[j];
        const double square = dx * dx + dy * dy + dz * dz + softening;
        const double g = strength * mass[i] * mass[j] / (square * std::sqrt(square));
        f[j] -= g * dx;
        f[bodies + j] -= g * dy;
        f[2 * bodies + j] -= g * dz;
        fx += g * dx;
        fy += g * dy;
        fz += g * dz;
      }
      f[i] += fx;
      f[bodies + i] += fy;
      f[2 * bodies + i] += fz;
    }
  }
};

}  // namespace hamgen::cost_table
