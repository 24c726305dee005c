// driven_oscillator, implicit-midpoint.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0, in C++17
//   command   hamgen generate hamiltonians/driven_oscillator.ham
//   model     hamiltonians/driven_oscillator.ham
//   sha256    0d13f020166373df1a9857cc611989e238d8089994687880f0185c1f259efcda
//   H(q, p, t) = p^2/2 + (1 + eps*cos(omega*t))*q^2/2
//   scheme    alpha = 1/2, beta = 0, gamma = 0: order 2, symmetric, symplectic
//   step      Q = q + h dH/dp, P = p - h dH/dq at qbar = (q + Q)/2, pbar = (p + P)/2
//   proved    symplectic, symmetric, order 2, emitted code
//   solve     linear solve of size 2 for q, p
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//             stage values of p_t: H does not depend on them
//   cost      per step: 36 + - *, 1 /, 2 sqrt and functions
//   flags     measured with -O3 -march=native -ffp-contract=off -fno-math-errno
#pragma once
#include <cmath>

#if defined __FAST_MATH__ || defined __ASSOCIATIVE_MATH__ || defined __RECIPROCAL_MATH__ || \
    defined __NO_SIGNED_ZEROS__ || (defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__ > 0)
#error "what rounding loses is kept here: compile without -ffast-math, -Ofast and parts of them"
#endif
#if defined __FLT_EVAL_METHOD__ && (__FLT_EVAL_METHOD__ < 0 || __FLT_EVAL_METHOD__ == 2)
#error "numbers must not be kept in wider registers: compile with -msse2 -mfpmath=sse"
#endif
#ifdef __clang__  // which has no macro for -fassociative-math
#pragma float_control(push)
#pragma clang fp reassociate(off)
#endif

#ifndef HAMGEN_SYSTEM_driven_oscillator
#define HAMGEN_SYSTEM_driven_oscillator 0xa7b96f3c
namespace driven_oscillator {
inline namespace emitted_a7b96f3c {

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

// H(q, p, t) + p_t, which is constant where H(q, p, t) is not.
inline Real energy(const Parameters& par, const State& z) {
  const Real q = z.q;
  const Real t = z.t;
  const Real p = z.p;
  const Real p_t = z.p_t;
  return p_t + 0.5 * (p * p) + 0.5 * (q * q) * (1.0 + par.eps * std::cos(par.omega * t));
}

// grad H, the derivatives by q first.
inline void gradient(const Parameters& par, const State& z, Real (&values)[4]) {
  const Real q = z.q;
  const Real t = z.t;
  const Real p = z.p;
  const Real t1 = par.omega * t;
  values[0] = q * (1.0 + par.eps * std::cos(t1));
  values[1] = -0.5 * par.eps * par.omega * (q * q) * std::sin(t1);
  values[2] = p;
  values[3] = 1.0;
}

}  // namespace emitted_a7b96f3c
}  // namespace driven_oscillator
#elif HAMGEN_SYSTEM_driven_oscillator != 0xa7b96f3c
#error "another system of this name is included before: generate one with --namespace"
#endif

// What follows knows nothing of the system.
namespace hamgen_9581d1fb::float64 {
using Real = double;

#ifndef HAMGEN_9581D1FB_FLOAT64_STEP_REPORT
#define HAMGEN_9581D1FB_FLOAT64_STEP_REPORT
// On failure the increment says how far the iteration was from its end; it is not finite where the
// step left the domain of H.
struct StepReport {
  bool converged = false;
  long long iterations = 0;
  Real increment = 0;
};
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_TWO_SUM
#define HAMGEN_9581D1FB_FLOAT64_TWO_SUM
// value += increment; what rounding loses is left in carry (two-sum of Knuth).
inline void two_sum(Real& value, Real& carry, Real increment) {
  const Real sum = value + increment;
  const Real part = sum - value;
  carry = (value - (sum - part)) + (increment - part);
  value = sum;
}
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_SUM_WITH_REST
#define HAMGEN_9581D1FB_FLOAT64_SUM_WITH_REST
// value + carry = value + increment + rest, for an increment that is not small and a rest that is,
// with the old carry in it: the new carry is what the rounded sums of all three lose.  That of the
// first is exact where the rest is the smaller of the two, else to the last place of the carry.
inline void two_sum_with_rest(Real& value, Real& carry, Real increment, Real rest) {
  const Real moved = increment + rest;
  const Real lost = rest - (moved - increment);
  two_sum(value, carry, moved);
  carry += lost;
}
#endif

}  // namespace hamgen_9581d1fb::float64

#ifndef HAMGEN_METHOD_driven_oscillator_implicit_midpoint
#define HAMGEN_METHOD_driven_oscillator_implicit_midpoint 0x294ddf08
namespace driven_oscillator::implicit_midpoint {
inline namespace emitted_294ddf08 {

namespace numerics = ::hamgen_9581d1fb::float64;
using numerics::StepReport, numerics::two_sum_with_rest;

// What depends on h and the parameters alone.
struct Coefficients {
  Real c1 = 0.0;  // h/2
  Real c2 = 0.0;  // -h/2
  Real c3 = 0.0;  // -eps*omega/2
};

inline Coefficients prepare(const Parameters& par, Real h) {
  Coefficients k;
  k.c1 = 0.5 * h;
  k.c2 = -0.5 * h;
  k.c3 = -0.5 * par.eps * par.omega;
  return k;
}

// dz + rest = Z - z for one step from z + carry; rest is small.
[[nodiscard]] inline StepReport solve(const Parameters& par, const Coefficients& k, Real h,
                                      const State& z, const State& carry, State& dz, State& rest) {
  StepReport report;
  const Real q = z.q;
  const Real t = z.t;
  const Real p = z.p;
  const Real rest_t = k.c1 + carry.t;
  const Real t_bar = t + rest_t;
  const Real t1 = par.omega * t_bar;
  const Real H_q_q = 1.0 + par.eps * std::cos(t1);
  const Real R_p_q = k.c1 * H_q_q;
  const Real inverse_det_q = 1.0 / (1.0 + k.c1 * R_p_q);
  const Real inverse_q_p = k.c1 * inverse_det_q;
  const Real inverse_p_q = -inverse_det_q * R_p_q;
  const Real q_bar = q * inverse_det_q + p * inverse_q_p;
  const Real p_bar = q * inverse_p_q + p * inverse_det_q;
  const Real H_q = q_bar * H_q_q;
  const Real q_gap = q_bar - q;
  const Real q_gap_1 = q_gap + p_bar * k.c2;
  const Real R_q = -(carry.q - q_gap_1);
  const Real p_gap = p_bar - p;
  const Real p_gap_1 = p_gap + k.c1 * H_q;
  const Real R_p = -(carry.p - p_gap_1);
  const Real delta_q = -(inverse_det_q * R_q + R_p * inverse_q_p);
  const Real delta_p = -(inverse_det_q * R_p + R_q * inverse_p_q);
  const Real change_H_q = delta_q * H_q_q;
  const Real q_bar_new = q_bar + delta_q;
  const Real H_t = k.c3 * (q_bar_new * q_bar_new) * std::sin(t1);
  dz.q = h * p_bar;
  rest.q = carry.q + h * delta_p;
  dz.t = h;
  rest.t = carry.t;
  dz.p = -h * H_q;
  rest.p = carry.p - h * change_H_q;
  dz.p_t = -h * H_t;
  rest.p_t = carry.p_t;
  // False for infinities and NaN alike.
  const Real length = (dz.q + rest.q) * (dz.q + rest.q) + (dz.t + rest.t) * (dz.t + rest.t) +
                      (dz.p + rest.p) * (dz.p + rest.p) + (dz.p_t + rest.p_t) * (dz.p_t + rest.p_t);
  report.converged = length <= 1.0e308;
  if (!report.converged) report.increment = length;
  return report;
}

// Advances z by one step of size h.  On failure z is left unchanged.
[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {
  const Coefficients k = prepare(par, h);
  State dz, rest;
  const StepReport report = solve(par, k, h, z, State(), dz, rest);
  if (!report.converged) return report;
  z.q += dz.q + rest.q;
  z.t += dz.t + rest.t;
  z.p += dz.p + rest.p;
  z.p_t += dz.p_t + rest.p_t;
  return report;
}

// Many steps: rounding errors of the updates are carried along.
class Propagator {
 public:
  Propagator(const Parameters& par, Real h, const State& z)
      : par_(par), h_(h), z_(z), k_(prepare(par, h)) {}

  // One step; on failure the state stays as it was.
  StepReport step() {
    State dz, rest;
    const StepReport report = solve(par_, k_, h_, z_, carry_, dz, rest);
    if (!report.converged) return report;
    two_sum_with_rest(z_.q, carry_.q, dz.q, rest.q);
    two_sum_with_rest(z_.t, carry_.t, dz.t, rest.t);
    two_sum_with_rest(z_.p, carry_.p, dz.p, rest.p);
    two_sum_with_rest(z_.p_t, carry_.p_t, dz.p_t, rest.p_t);
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

  // Begins anew at z, as a new Propagator would.
  void reset(const State& z) {
    z_ = z;
    carry_ = State();
  }

  [[nodiscard]] const State& state() const { return z_; }
  // What rounding took from the state: the sum of both is what the steps go on from.
  [[nodiscard]] const State& carry() const { return carry_; }
  [[nodiscard]] Real time() const { return z_.t; }
  [[nodiscard]] Real h() const { return h_; }
  [[nodiscard]] const Parameters& parameters() const { return par_; }

 private:
  Parameters par_;
  Real h_;
  State z_;
  State carry_;
  Coefficients k_;
};

}  // namespace emitted_294ddf08
}  // namespace driven_oscillator::implicit_midpoint
#elif HAMGEN_METHOD_driven_oscillator_implicit_midpoint != 0x294ddf08
#error "another method of this name is included before: generate one with --namespace"
#endif

#ifdef __clang__
#pragma float_control(pop)
#endif
