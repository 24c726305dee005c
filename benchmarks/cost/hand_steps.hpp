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

}  // namespace hamgen::cost_table
