// driven_oscillator, implicit-midpoint.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0
//   command   hamgen generate hamiltonians/driven_oscillator.ham
//   model     hamiltonians/driven_oscillator.ham
//   H(q, p) = p^2/2 + (1 + eps*cos(omega*t))*q^2/2
//   scheme    alpha = 1/2, beta = 0, gamma = 0: order 2, symmetric, symplectic
//   proved    symplectic, symmetric, order 2, emitted code
//   solve     linear solve of size 1 for q; p torn out
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//             stage values of p_t: H does not depend on them
//             1 of the unknowns: torn out
//   cost      per step: 15 + - *, 1 /, 2 sqrt and functions
#pragma once
#include <cmath>

namespace driven_oscillator::implicit_midpoint {

using Real = double;

struct Parameters {
  Real eps = 0.2;    // depth of the modulation
  Real omega = 1.0;  // its frequency
};

struct State {
  Real q = 0.0;
  Real t = 0.0;    // time
  Real p = 0.0;
  Real p_t = 0.0;  // momentum of time: minus the energy, up to a constant
};

// On failure the increment says how far the iteration was from its end; it is not finite
// where the step left the domain of H.
struct StepReport {
  bool converged = false;
  int iterations = 0;
  Real increment = 0.0;
};

// H(q, p).
inline Real energy([[maybe_unused]] const Parameters& par, [[maybe_unused]] const State& z) {
  const Real q = z.q;
  const Real t = z.t;
  const Real p = z.p;
  const Real p_t = z.p_t;
  return p_t + 0.5 * (p * p) + 0.5 * (q * q) * (1.0 + par.eps * std::cos(par.omega * t));
}

// What depends on h and the parameters alone.
struct Coefficients {
  Real c1 = 0.0;  // h/2
  Real c2 = 0.0;  // -h/2
  Real c3 = 0.0;  // -eps*omega/2
};

inline Coefficients prepare([[maybe_unused]] const Parameters& par, [[maybe_unused]] Real h) {
  Coefficients k;
  k.c1 = 0.5 * h;
  k.c2 = -0.5 * h;
  k.c3 = -0.5 * par.eps * par.omega;
  return k;
}

// value += increment, with what rounding loses kept in carry (two-sum of Knuth).
inline void add(Real& value, Real& carry, Real increment) {
  const Real wanted = increment + carry;
  const Real sum = value + wanted;
  const Real part = sum - value;
  carry = (value - (sum - part)) + (wanted - part);
  value = sum;
}

// dz = Z - z for one step from z.
[[nodiscard]] inline StepReport solve([[maybe_unused]] const Parameters& par, const Coefficients& k,
                                      [[maybe_unused]] Real h, [[maybe_unused]] const State& z,
                                      State& dz) {
  StepReport report;
  const Real q = z.q;
  const Real t = z.t;
  const Real p = z.p;
  const Real t_bar = t + k.c1;
  const Real t1 = par.omega * t_bar;
  const Real H_q_q = 1.0 + par.eps * std::cos(t1);
  const Real d_p_d_q = k.c2 * H_q_q;
  const Real R_q = -(q + p * k.c1);
  const Real R_q_q = 1.0 + k.c2 * d_p_d_q;
  const Real delta_q = -R_q / R_q_q;
  const Real H_q_new = delta_q * H_q_q;
  const Real H_p_new = p + d_p_d_q * delta_q;
  const Real H_t = k.c3 * (delta_q * delta_q) * std::sin(t1);
  dz.q = h * H_p_new;
  dz.t = h;
  dz.p = -h * H_q_new;
  dz.p_t = -h * H_t;
  // False for infinities and NaN alike.
  const Real length = dz.q * dz.q + dz.t * dz.t + dz.p * dz.p + dz.p_t * dz.p_t;
  report.converged = length <= 1.0e308;
  if (!report.converged) report.increment = length;
  return report;
}

// Advances z by one step of size h.  On failure z is left unchanged.
[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {
  const Coefficients k = prepare(par, h);
  State dz;
  const StepReport report = solve(par, k, h, z, dz);
  if (!report.converged) return report;
  z.q += dz.q;
  z.t += dz.t;
  z.p += dz.p;
  z.p_t += dz.p_t;
  return report;
}

// Many steps: rounding errors of the updates are carried along.
class Propagator {
 public:
  Propagator(const Parameters& par, Real h, const State& z)
      : par_(par), h_(h), z_(z), k_(prepare(par, h)) {}

  // One step; on failure the state stays as it was.
  StepReport step() {
    State dz;
    const StepReport report = solve(par_, k_, h_, z_, dz);
    if (!report.converged) return report;
    add(z_.q, carry_.q, dz.q);
    add(z_.t, carry_.t, dz.t);
    add(z_.p, carry_.p, dz.p);
    add(z_.p_t, carry_.p_t, dz.p_t);
    return report;
  }

  // Up to `steps` steps; stops at the first failure.  The report sums the iterations.
  StepReport advance(long long steps) {
    StepReport total;
    total.converged = true;
    for (long long i = 0; i < steps; ++i) {
      const StepReport report = step();
      total.iterations += report.iterations;
      total.increment = report.increment;
      if (!report.converged) {
        total.converged = false;
        break;
      }
    }
    return total;
  }

  [[nodiscard]] const State& state() const { return z_; }

 private:
  Parameters par_;
  Real h_;
  State z_;
  State carry_;
  Coefficients k_;
};

}  // namespace driven_oscillator::implicit_midpoint
