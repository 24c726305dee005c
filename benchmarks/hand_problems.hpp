// Problems as one writes them by hand: the forces of H = sum m_i p_i^2/2 + V(q), f = V'(q), with
// inverse_mass(i), or the flow dz = J grad H(z) of any H.  Those that a midpoint step by hand is
// made for have `look_back` values of an extrapolation and `iterations` of a fixed point.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace hamgen::benchmarks {

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

// The Sun and the outer planets of hamiltonians/outer_solar_system.ham.
inline HandBodies<6, 5, 1> outer_planets() {
  HandBodies<6, 5, 1> planets;
  planets.mass = {1.00000597682,      0.000954786104043,  0.000285583733151,
                  0.0000437273164546, 0.0000517759138449, 1 / 1.3e8};
  planets.strength = 2.95912208286e-4;
  return planets;
}
inline HandBodies<50, 5, 1> fifty_bodies() {
  HandBodies<50, 5, 1> bodies;
  bodies.mass.fill(1.0);
  bodies.strength = 1.0 / 50;
  bodies.softening = 0.01;
  return bodies;
}

}  // namespace hamgen::benchmarks
