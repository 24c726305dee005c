// harmonic, implicit-midpoint.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0
//   command   hamgen generate hamiltonians/harmonic.ham
//   model     hamiltonians/harmonic.ham
//   H(q, p) = p^2/2 + w^2*q^2/2
//   scheme    alpha = 1/2, beta = 0, gamma = 0: order 2, symmetric, symplectic
//   proved    symplectic, symmetric, order 2, emitted code
//   solve     linear solve of size 1 for q, constant matrix hoisted; p torn out
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//             1 of the unknowns: torn out
//   cost      per step: 6 + - *
#pragma once

namespace harmonic::implicit_midpoint {

using Real = double;

struct Parameters {
  Real w = 1.0;  // angular frequency
};

struct State {
  Real q = 0.0;
  Real p = 0.0;
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
  const Real p = z.p;
  return 0.5 * (p * p + par.w * par.w * (q * q));
}

// What depends on h and the parameters alone.
struct Coefficients {
  Real c1 = 0.0;  // w^2
  Real c2 = 0.0;  // -h*w^2/2
  Real c3 = 0.0;  // h/2
  Real c4 = 0.0;  // 1 + h^2*w^2/4
  Real c5 = 0.0;  // 1/(1 + h^2*w^2/4)
};

inline Coefficients prepare([[maybe_unused]] const Parameters& par, [[maybe_unused]] Real h) {
  Coefficients k;
  k.c1 = par.w * par.w;
  k.c2 = -0.5 * h * k.c1;
  k.c3 = 0.5 * h;
  k.c4 = 1.0 - 0.5 * h * k.c2;
  k.c5 = 1.0 / k.c4;
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
  const Real p = z.p;
  const Real R_q = -(q + p * k.c3);
  const Real delta_q = -k.c5 * R_q;
  const Real H_q_new = delta_q * k.c1;
  const Real H_p_new = p + k.c2 * delta_q;
  dz.q = h * H_p_new;
  dz.p = -h * H_q_new;
  // False for infinities and NaN alike.
  const Real length = dz.q * dz.q + dz.p * dz.p;
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
  z.p += dz.p;
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
    add(z_.p, carry_.p, dz.p);
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

}  // namespace harmonic::implicit_midpoint
