// The step by hand: no generator, no GiNaC, no tearing.  H is a C++ function of jets (value,
// gradient and Hessian by automatic differentiation), and the 2n equations are solved by plain
// dense Newton.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace hamgen::numerics_test {

// f, f_i, f_ij of a function of m variables.
template <class Real>
struct Jet {
  Real value = 0;
  std::vector<Real> d;
  std::vector<Real> dd;  // m x m; empty where nobody wants it

  static Jet variable(std::size_t m, std::size_t i, Real x, bool second) {
    Jet jet{x, std::vector<Real>(m), std::vector<Real>(second ? m * m : 0)};
    jet.d[i] = 1;
    return jet;
  }
  // g(f) from g, g', g'' at f.
  Jet through(Real g, Real g1, Real g2) const {
    Jet result{g, d, dd};
    const std::size_t m = d.size();
    for (std::size_t i = 0; i < m; ++i) {
      result.d[i] = g1 * d[i];
      for (std::size_t j = 0; j < m && !dd.empty(); ++j) {
        result.dd[i * m + j] = g1 * dd[i * m + j] + g2 * d[i] * d[j];
      }
    }
    return result;
  }
  friend Jet operator+(Jet a, const Jet& b) {
    a.value += b.value;
    for (std::size_t i = 0; i < a.d.size(); ++i) a.d[i] += b.d[i];
    for (std::size_t i = 0; i < a.dd.size(); ++i) a.dd[i] += b.dd[i];
    return a;
  }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet result = a;
    const std::size_t m = a.d.size();
    result.value = a.value * b.value;
    for (std::size_t i = 0; i < m; ++i) {
      result.d[i] = a.d[i] * b.value + a.value * b.d[i];
      for (std::size_t j = 0; j < m && !a.dd.empty(); ++j) {
        result.dd[i * m + j] = a.dd[i * m + j] * b.value + a.value * b.dd[i * m + j] +
                               a.d[i] * b.d[j] + a.d[j] * b.d[i];
      }
    }
    return result;
  }
  friend Jet operator*(Real c, const Jet& a) { return a.through(c * a.value, c, 0); }
  friend Jet operator+(Real c, Jet a) {
    a.value += c;
    return a;
  }
  friend Jet operator-(const Jet& a) { return Real(-1) * a; }
  friend Jet operator-(const Jet& a, const Jet& b) { return a + (-b); }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const Real r = 1 / b.value;
    return a * b.through(r, -r * r, 2 * r * r * r);
  }
  friend Jet sin(const Jet& a) {
    return a.through(std::sin(a.value), std::cos(a.value), -std::sin(a.value));
  }
  friend Jet cos(const Jet& a) {
    return a.through(std::cos(a.value), -std::sin(a.value), -std::cos(a.value));
  }
  friend Jet exp(const Jet& a) {
    const Real e = std::exp(a.value);
    return a.through(e, e, e);
  }
  friend Jet atan(const Jet& a) {
    const Real r = 1 / (1 + a.value * a.value);
    return a.through(std::atan(a.value), r, -2 * a.value * r * r);
  }
  friend Jet sqrt(const Jet& a) {
    const Real r = std::sqrt(a.value);
    return a.through(r, 1 / (2 * r), -1 / (4 * r * a.value));
  }
};

// x of A x = b by Gaussian elimination with partial pivoting.
template <class Real>
std::vector<Real> solve_dense(std::vector<std::vector<Real>> a, std::vector<Real> b) {
  const std::size_t m = b.size();
  for (std::size_t c = 0; c < m; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < m; ++r) {
      if (std::abs(a[r][c]) > std::abs(a[pivot][c])) pivot = r;
    }
    std::swap(a[c], a[pivot]);
    std::swap(b[c], b[pivot]);
    for (std::size_t r = c + 1; r < m; ++r) {
      const Real factor = a[r][c] / a[c][c];
      for (std::size_t j = c; j < m; ++j) a[r][j] -= factor * a[c][j];
      b[r] -= factor * b[c];
    }
  }
  for (std::size_t r = m; r-- > 0;) {
    for (std::size_t j = r + 1; j < m; ++j) b[r] -= a[r][j] * b[j];
    b[r] /= a[r][r];
  }
  return b;
}

// alpha, beta, gamma for every degree of freedom.
template <class Real>
struct Parameters3 {
  std::vector<Real> alpha, beta, gamma;
};

// H as a function of 2n jets, q first.
template <class Real, class Hamiltonian>
Jet<Real> jet_of(const Hamiltonian& hamiltonian, const std::vector<Real>& z, bool second = true) {
  std::vector<Jet<Real>> variables;
  for (std::size_t i = 0; i < z.size(); ++i) {
    variables.push_back(Jet<Real>::variable(z.size(), i, z[i], second));
  }
  return hamiltonian(variables);
}

// zbar from (z, Z) as the paper writes it.
template <class Real>
std::vector<Real> stage_value(const Parameters3<Real>& c, const std::vector<Real>& z,
                              const std::vector<Real>& next) {
  const std::size_t n = z.size() / 2;
  std::vector<Real> bar(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const Real q = z[i], p = z[n + i], Q = next[i], P = next[n + i];
    bar[i] = c.alpha[i] * Q + (1 - c.alpha[i]) * q + c.gamma[i] * (p - P);
    bar[n + i] = c.alpha[i] * p + (1 - c.alpha[i]) * P + c.beta[i] * (q - Q);
  }
  return bar;
}

// z + h J grad H(bar).
template <class Real, class Hamiltonian>
std::vector<Real> advanced(const Hamiltonian& hamiltonian, Real h, const std::vector<Real>& z,
                           const std::vector<Real>& bar) {
  const std::size_t n = z.size() / 2;
  const Jet<Real> at_bar = jet_of(hamiltonian, bar, false);
  std::vector<Real> next = z;
  for (std::size_t i = 0; i < n; ++i) {
    next[i] += h * at_bar.d[n + i];
    next[n + i] -= h * at_bar.d[i];
  }
  return next;
}

// One step: Newton on all 2n components of Z - z - h J grad H(zbar(z, Z)) = 0.
template <class Real, class Hamiltonian>
std::vector<Real> dense_step(const Hamiltonian& hamiltonian, const Parameters3<Real>& c, Real h,
                             const std::vector<Real>& z) {
  const std::size_t n = z.size() / 2;
  std::vector<Real> next = advanced(hamiltonian, h, z, z);
  Real previous = HUGE_VALL;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const std::vector<Real> bar = stage_value(c, z, next);
    const Jet<Real> jet = jet_of(hamiltonian, bar);
    std::vector<Real> residual(2 * n);
    std::vector<std::vector<Real>> matrix(2 * n, std::vector<Real>(2 * n));
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const std::size_t row = i < n ? n + i : i - n;  // of the gradient
      const Real sign = i < n ? 1 : -1;
      residual[i] = next[i] - z[i] - sign * h * jet.d[row];
      for (std::size_t k = 0; k < n; ++k) {
        const Real by_q = jet.dd[row * 2 * n + k];
        const Real by_p = jet.dd[row * 2 * n + n + k];
        // d qbar_k / dQ_k = alpha, d qbar_k / dP_k = -gamma; d pbar_k / dQ_k = -beta, / dP_k = 1 -
        // alpha.
        matrix[i][k] = (i == k) - sign * h * (by_q * c.alpha[k] - by_p * c.beta[k]);
        matrix[i][n + k] = (i == n + k) - sign * h * (by_p * (1 - c.alpha[k]) - by_q * c.gamma[k]);
      }
    }
    const std::vector<Real> correction = solve_dense(matrix, residual);
    Real size = 0;
    for (std::size_t i = 0; i < 2 * n; ++i) {
      next[i] -= correction[i];
      size += std::abs(correction[i]);
    }
    if (!(size < previous) && size < 1e-12L) return next;
    previous = size;
  }
  throw std::runtime_error("the reference step does not converge");
}

// The paper's Algorithm 1 with kappa sweeps.
template <class Real, class Hamiltonian>
std::vector<Real> algorithm_1(const Hamiltonian& hamiltonian, const Parameters3<Real>& c, Real h,
                              const std::vector<Real>& z, int kappa) {
  std::vector<Real> next = advanced(hamiltonian, h, z, z);
  for (int j = 0; j < kappa; ++j) {
    next = advanced(hamiltonian, h, z, stage_value(c, z, next));
  }
  return next;
}

}  // namespace hamgen::numerics_test
