// Steps by hand, for one problem each, when nothing but speed counts: implicit midpoint by a fixed
// point from an extrapolated start, with constants tuned to the problem, no compensated sums and no
// report; and Stormer-Verlet, with the sums.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hamgen::cost_table {

// The polynomial of degree room - 1 through the last `room` vectors, at the next place.
template <std::size_t n, std::size_t room>
class Extrapolation {
 public:
  using Vector = std::array<double, n>;

  [[nodiscard]] bool ready() const { return known_ == room; }
  void predict(Vector& next) const {
    constexpr std::array<double, room> w = weights();
    std::array<const double*, room> past;
    for (std::size_t j = 0; j < room; ++j) past[j] = past_[(newest_ + room - j) % room].data();
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < room; ++j) sum += w[j] * past[j][i];
      next[i] = sum;
    }
  }
  void add(const Vector& value) {
    newest_ = (newest_ + 1) % room;
    known_ += ready() ? 0 : 1;
    past_[newest_] = value;
  }

 private:
  static constexpr std::array<double, room> weights() {
    std::array<double, room> w = {};
    double binomial = 1;
    for (std::size_t j = 0; j < room; ++j) {
      binomial = binomial * static_cast<double>(room - j) / static_cast<double>(j + 1);
      w[j] = j % 2 == 0 ? binomial : -binomial;
    }
    return w;
  }

  std::array<Vector, room> past_ = {};
  std::size_t newest_ = 0;
  std::size_t known_ = 0;
};

// So many iterations solve every equation here.
inline constexpr int kEnough = 60;

// H = sum m_i p_i^2/2 + V(q).  Problem: n, inverse_mass(i), force(q, f) with f = V'(q),
// `look_back` values of the extrapolation, `iterations` of the fixed point.
template <class Problem>
class HandMidpoint {
 public:
  static constexpr std::size_t n = Problem::n;

  HandMidpoint(const Problem& problem, double h, const std::vector<double>& z)
      : problem_(problem), h_(h) {
    std::copy_n(z.begin(), n, q_.begin());
    std::copy_n(z.begin() + n, n, p_.begin());
  }
  void advance(long steps) {
    for (long s = 0; s < steps; ++s) step(Problem::iterations);
  }
  void step(int iterations) {
    const double half = h_ / 2;
    Vector bar;
    Vector force;
    if (past_.ready()) {
      past_.predict(bar);
    } else {
      iterations = kEnough;
      for (std::size_t i = 0; i < n; ++i) bar[i] = q_[i] + half * problem_.inverse_mass(i) * p_[i];
    }
    // The coordinates first: the last force serves the momenta too.
    for (int k = iterations;; --k) {
      problem_.force(bar.data(), force.data());
      if (k == 0) break;
      for (std::size_t i = 0; i < n; ++i) {
        bar[i] = q_[i] + half * problem_.inverse_mass(i) * (p_[i] - half * force[i]);
      }
    }
    past_.add(bar);
    for (std::size_t i = 0; i < n; ++i) {
      const double momentum = p_[i] - half * force[i];
      q_[i] += h_ * problem_.inverse_mass(i) * momentum;
      p_[i] -= h_ * force[i];
    }
  }
  // q, then p.
  [[nodiscard]] double value(std::size_t i) const { return i < n ? q_[i] : p_[i - n]; }

 private:
  using Vector = std::array<double, n>;

  Problem problem_;
  double h_;
  Vector q_, p_;
  Extrapolation<n, Problem::look_back> past_;
};

// Any H.  Problem: n, flow(z, dz) with dz = J grad H(z), `look_back`, `iterations`.
template <class Problem>
class HandMidpointOfAll {
 public:
  static constexpr std::size_t n = Problem::n;

  HandMidpointOfAll(const Problem& problem, double h, const std::vector<double>& z)
      : problem_(problem), h_(h) {
    std::copy_n(z.begin(), 2 * n, z_.begin());
  }
  void advance(long steps) {
    for (long s = 0; s < steps; ++s) step(Problem::iterations);
  }
  void step(int iterations) {
    Vector bar;
    Vector flow;
    if (past_.ready()) {
      past_.predict(bar);
    } else {
      iterations = kEnough;
      bar = z_;
    }
    for (int k = iterations;; --k) {
      problem_.flow(bar.data(), flow.data());
      if (k == 0) break;
      for (std::size_t i = 0; i < 2 * n; ++i) bar[i] = z_[i] + h_ / 2 * flow[i];
    }
    past_.add(bar);
    for (std::size_t i = 0; i < 2 * n; ++i) z_[i] += h_ * flow[i];
  }
  // q, then p.
  [[nodiscard]] double value(std::size_t i) const { return z_[i]; }

 private:
  using Vector = std::array<double, 2 * n>;

  Problem problem_;
  double h_;
  Vector z_;
  Extrapolation<2 * n, Problem::look_back> past_;
};

// Kick, drift, kick with compensated sums, the last kick's force kept.
template <class Problem>
class HandVerlet {
 public:
  static constexpr std::size_t n = Problem::n;

  HandVerlet(const Problem& problem, double h, const std::vector<double>& z)
      : problem_(problem), h_(h) {
    std::copy_n(z.begin(), n, q_.begin());
    std::copy_n(z.begin() + n, n, p_.begin());
    problem_.force(q_.data(), force_.data());
  }
  void advance(long steps) {
    for (long s = 0; s < steps; ++s) step();
  }
  // q, then p.
  [[nodiscard]] double value(std::size_t i) const { return i < n ? q_[i] : p_[i - n]; }

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
      add(q_[i], q_carry_[i], h_ * problem_.inverse_mass(i) * p_[i]);
    }
    problem_.force(q_.data(), force_.data());
    for (std::size_t i = 0; i < n; ++i) add(p_[i], p_carry_[i], -half * force_[i]);
  }

  Problem problem_;
  double h_;
  Vector q_, p_, force_ = {}, q_carry_ = {}, p_carry_ = {};
};

// How far steps are from the solutions of their equations, at most, relative to the largest of q
// and of p.
template <class Hand>
double lack_of(Hand hand, int iterations, long steps) {
  double worst = 0;
  for (long s = 0; s < steps; ++s) {
    Hand exact = hand;
    exact.step(kEnough);
    hand.step(iterations);
    for (std::size_t part = 0; part < 2; ++part) {
      double largest = 0;
      double off = 0;
      for (std::size_t i = part * Hand::n; i < (part + 1) * Hand::n; ++i) {
        largest = std::max(largest, std::fabs(exact.value(i)));
        off = std::max(off, std::fabs(hand.value(i) - exact.value(i)));
      }
      worst = std::max(worst, off / largest);
    }
  }
  return worst;
}

struct HandPendulum {
  static constexpr std::size_t n = 1;
  double eps = 0.03;

  static double inverse_mass(std::size_t) { return 1; }
  void force(const double* q, double* f) const { f[0] = eps * std::sin(q[0]); }
};

struct HandHenonHeiles {
  static constexpr std::size_t n = 2;

  static double inverse_mass(std::size_t) { return 1; }
  void force(const double* q, double* f) const {
    f[0] = q[0] + 2 * q[0] * q[1];
    f[1] = q[1] + q[0] * q[0] - q[1] * q[1];
  }
};

struct HandKepler {
  static constexpr std::size_t n = 2;

  static double inverse_mass(std::size_t) { return 1; }
  void force(const double* q, double* f) const {
    const double square = q[0] * q[0] + q[1] * q[1];
    const double g = 1 / (square * std::sqrt(square));
    f[0] = g * q[0];
    f[1] = g * q[1];
  }
};

// H = (q^2 + 1)(p^2 + 1)/2.
struct HandProduct {
  static constexpr std::size_t n = 1;
  static constexpr std::size_t look_back = 10;
  static constexpr int iterations = 3;

  void flow(const double* z, double* dz) const {
    dz[0] = (z[0] * z[0] + 1) * z[1];
    dz[1] = -z[0] * (z[1] * z[1] + 1);
  }
};

// H = (p1^2 + 2 p2^2 - 2 p1 p2 c)/(2 (1 + s^2)) - 2 cos q1 - cos q2, c and s of q1 - q2.
struct HandDoublePendulum {
  static constexpr std::size_t n = 2;
  static constexpr std::size_t look_back = 8;
  static constexpr int iterations = 3;

  void flow(const double* z, double* dz) const {
    const double c = std::cos(z[0] - z[1]);
    const double s = std::sin(z[0] - z[1]);
    const double inverse = 1 / (1 + s * s);
    const double v1 = (z[2] - z[3] * c) * inverse;
    const double v2 = (2 * z[3] - z[2] * c) * inverse;
    const double kinetic = (z[2] * v1 + z[3] * v2) / 2;
    const double torque = (z[2] * z[3] - 2 * c * kinetic) * s * inverse;
    dz[0] = v1;
    dz[1] = v2;
    dz[2] = -torque - 2 * std::sin(z[0]);
    dz[3] = torque - std::sin(z[1]);
  }
};

// H = sum p_i^2/2 - (C^2 + S^2)/(2 n), C and S the sums of cosines and sines.
template <std::size_t size>
struct HandMeanField {
  static constexpr std::size_t n = size;
  static constexpr std::size_t look_back = 6;
  static constexpr int iterations = 4;

  static double inverse_mass(std::size_t) { return 1; }
  void force(const double* __restrict q, double* __restrict f) const {
    std::array<double, n> c;
    double all_c = 0;
    double all_s = 0;
    for (std::size_t i = 0; i < n; ++i) {
      c[i] = std::cos(q[i]);
      f[i] = std::sin(q[i]);
      all_c += c[i];
      all_s += f[i];
    }
    for (std::size_t i = 0; i < n; ++i) f[i] = (f[i] * all_c - c[i] * all_s) / n;
  }
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
