// Problems, H = |p|^2/2 + V(q), as a user without hamgen writes them.  A state is
// (q_1, ..., q_n, p_1, ..., p_n).
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace hamgen::benchmarks {

template <std::size_t n, class Real = double>
using Vector = std::array<Real, n>;

// V = -eps cos q, started near the separatrix: mathematics and scene of hamiltonians/pendulum.ham.
struct Pendulum {
  static constexpr const char* name = "pendulum";
  static constexpr std::size_t n = 1;
  static constexpr double h = 0.1;
  static constexpr Vector<2> start = {3.1, 0.0};
  // Extrapolated from so many midpoints, the start of Newton's iteration is exact to 1e-8.
  static constexpr std::size_t history = 7;

  double eps = 0.03;

  template <class Real>
  Real potential(const Vector<1, Real>& q) const {
    return -Real(eps) * std::cos(q[0]);
  }
  // dV/dq and d2V/dq2.
  template <class Real>
  void derivatives(const Vector<1, Real>& q, Vector<1, Real>& slope,
                   Vector<1, Real>& hessian) const {
    slope[0] = Real(eps) * std::sin(q[0]);
    hessian[0] = Real(eps) * std::cos(q[0]);
  }
};

// V = (q1^2 + q2^2)/2 + q1^2 q2 - q2^3/3, H = 0.0743: a regular orbit below the escape at 1/6.
struct HenonHeiles {
  static constexpr const char* name = "henon_heiles";
  static constexpr std::size_t n = 2;
  static constexpr double h = 0.1;
  static constexpr Vector<4> start = {0.1, 0.2, 0.3, -0.1};
  static constexpr std::size_t history = 13;

  template <class Real>
  Real potential(const Vector<2, Real>& q) const {
    return (q[0] * q[0] + q[1] * q[1]) / 2 + q[0] * q[0] * q[1] - q[1] * q[1] * q[1] / 3;
  }
  // dV/dq and the entries (1,1), (1,2), (2,2) of d2V/dq2.
  template <class Real>
  void derivatives(const Vector<2, Real>& q, Vector<2, Real>& slope,
                   Vector<3, Real>& hessian) const {
    slope[0] = q[0] + 2 * q[0] * q[1];
    slope[1] = q[1] + q[0] * q[0] - q[1] * q[1];
    hessian[0] = 1 + 2 * q[1];
    hessian[1] = 2 * q[0];
    hessian[2] = 1 - 2 * q[1];
  }
};

// V = -1/r, from the pericentre of an ellipse with e = 0.6.
struct Kepler {
  static constexpr const char* name = "kepler";
  static constexpr std::size_t n = 2;
  static constexpr double h = 0.01;
  static constexpr Vector<4> start = {0.4, 0, 0, 2};
  static constexpr std::size_t history = 9;

  template <class Real>
  Real potential(const Vector<2, Real>& q) const {
    return -1 / std::sqrt(q[0] * q[0] + q[1] * q[1]);
  }
  // dV/dq and the entries (1,1), (1,2), (2,2) of d2V/dq2.
  template <class Real>
  void derivatives(const Vector<2, Real>& q, Vector<2, Real>& slope,
                   Vector<3, Real>& hessian) const {
    const Real inverse_square = 1 / (q[0] * q[0] + q[1] * q[1]);
    const Real g = inverse_square * std::sqrt(inverse_square);
    const Real curvature = 3 * inverse_square * g;
    slope[0] = g * q[0];
    slope[1] = g * q[1];
    hessian[0] = g - curvature * (q[0] * q[0]);
    hessian[1] = -curvature * (q[0] * q[1]);
    hessian[2] = g - curvature * (q[1] * q[1]);
  }
};

// Upper triangle of a symmetric n x n matrix, row by row.
template <std::size_t n, class Real = double>
using Symmetric = Vector<n*(n + 1) / 2, Real>;

template <class Problem>
using State = Vector<2 * Problem::n>;

// H, in long double so that the rounding of H itself stays out of the energy errors.
template <class Problem>
long double energy(const Problem& problem, const State<Problem>& z) {
  constexpr std::size_t n = Problem::n;
  Vector<n, long double> q;
  long double kinetic = 0;
  for (std::size_t i = 0; i < n; ++i) {
    q[i] = z[i];
    kinetic += static_cast<long double>(z[n + i]) * z[n + i] / 2;
  }
  return kinetic + problem.potential(q);
}

}  // namespace hamgen::benchmarks
