// henon_heiles, symplectic-euler-a.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0, in C++17
//   command   hamgen generate hamiltonians/henon_heiles.ham --scheme symplectic-euler-a
//   model     hamiltonians/henon_heiles.ham
//   sha256    f75a53ebb72441b825d60836e9fcaf27d8e66aed55482ee8005894e2d6112f72
//   H(q, p) = (p1^2 + p2^2 + q1^2 + q2^2)/2 + q1^2*q2 - q2^3/3
//   scheme    alpha = 0, beta = 0, gamma = 0: order 1, symplectic
//   step      Q = q + h dH/dp, P = p - h dH/dq at qbar = q, pbar = P
//   proved    symplectic, order 1, emitted code
//   refuted   symmetric
//   solve     explicit
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//             equation solver: the step is explicit
//   cost      per step: 29 + - *
//   flags     measured with -O3 -march=native -ffp-contract=off -fno-math-errno
#pragma once

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

#ifndef HAMGEN_SYSTEM_henon_heiles
#define HAMGEN_SYSTEM_henon_heiles 0xe006a499
namespace henon_heiles {
inline namespace emitted_e006a499 {

using Real = double;

struct Parameters {};

struct State {
  Real q1 = 0.0;
  Real q2 = 0.0;
  Real p1 = 0.0;
  Real p2 = 0.0;
};

// H(q, p).
inline Real energy(const Parameters&, const State& z) {
  const Real q1 = z.q1;
  const Real q2 = z.q2;
  const Real p1 = z.p1;
  const Real p2 = z.p2;
  const Real t1 = q1 * q1;
  const Real t2 = q2 * q2;
  return 0.5 * t1 + 0.5 * t2 + 0.5 * (p1 * p1) + 0.5 * (p2 * p2) + q2 * t1 - (1.0 / 3.0) * q2 * t2;
}

// grad H, the derivatives by q first.
inline void gradient(const Parameters&, const State& z, Real (&values)[4]) {
  const Real q1 = z.q1;
  const Real q2 = z.q2;
  const Real p1 = z.p1;
  const Real p2 = z.p2;
  values[0] = q1 + 2.0 * q1 * q2;
  values[1] = q2 + q1 * q1 - q2 * q2;
  values[2] = p1;
  values[3] = p2;
}

}  // namespace emitted_e006a499
}  // namespace henon_heiles
#elif HAMGEN_SYSTEM_henon_heiles != 0xe006a499
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

#ifndef HAMGEN_9581D1FB_FLOAT64_DIFFERENCE_ERROR
#define HAMGEN_9581D1FB_FLOAT64_DIFFERENCE_ERROR
// x - y less its rounded value (Knuth): exact whatever their sizes.
inline Real difference_error(Real x, Real y) {
  const Real difference = x - y;
  const Real part = x - difference;
  return (x - (difference + part)) + (part - y);
}
#endif

}  // namespace hamgen_9581d1fb::float64

#ifndef HAMGEN_METHOD_henon_heiles_symplectic_euler_a
#define HAMGEN_METHOD_henon_heiles_symplectic_euler_a 0x3a1842c6
namespace henon_heiles::symplectic_euler_a {
inline namespace emitted_3a1842c6 {

namespace numerics = ::hamgen_9581d1fb::float64;
using numerics::StepReport, numerics::two_sum_with_rest, numerics::difference_error;

// dz + rest = Z - z for one step from z + carry; rest is small.
[[nodiscard]] inline StepReport solve(const Parameters&, Real h, const State& z, const State& carry,
                                      State& dz, State& rest) {
  StepReport report;
  const Real q1 = z.q1;
  const Real q2 = z.q2;
  const Real p1 = z.p1;
  const Real p2 = z.p2;
  const Real q1_bar = q1 + carry.q1;
  const Real q2_bar = q2 + carry.q2;
  const Real H_q1 = q1_bar + 2.0 * q1_bar * q2_bar;
  const Real flow_p1 = h * H_q1;
  const Real first_p1 = p1 - flow_p1;
  const Real lost_p1 = difference_error(p1, flow_p1);
  const Real rest_p1 = carry.p1 + lost_p1;
  const Real p1_bar = first_p1 + rest_p1;
  const Real H_q2 = q2_bar + q1_bar * q1_bar - q2_bar * q2_bar;
  const Real flow_p2 = h * H_q2;
  const Real first_p2 = p2 - flow_p2;
  const Real lost_p2 = difference_error(p2, flow_p2);
  const Real rest_p2 = carry.p2 + lost_p2;
  const Real p2_bar = first_p2 + rest_p2;
  dz.q1 = h * p1_bar;
  rest.q1 = carry.q1;
  dz.q2 = h * p2_bar;
  rest.q2 = carry.q2;
  dz.p1 = -h * H_q1;
  rest.p1 = carry.p1;
  dz.p2 = -h * H_q2;
  rest.p2 = carry.p2;
  // False for infinities and NaN alike.
  const Real length = (dz.q1 + rest.q1) * (dz.q1 + rest.q1) +
                      (dz.q2 + rest.q2) * (dz.q2 + rest.q2) +
                      (dz.p1 + rest.p1) * (dz.p1 + rest.p1) + (dz.p2 + rest.p2) * (dz.p2 + rest.p2);
  report.converged = length <= 1.0e308;
  if (!report.converged) report.increment = length;
  return report;
}

// Advances z by one step of size h.  On failure z is left unchanged.
[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {
  State dz, rest;
  const StepReport report = solve(par, h, z, State(), dz, rest);
  if (!report.converged) return report;
  z.q1 += dz.q1 + rest.q1;
  z.q2 += dz.q2 + rest.q2;
  z.p1 += dz.p1 + rest.p1;
  z.p2 += dz.p2 + rest.p2;
  return report;
}

// Many steps: rounding errors of the updates are carried along.
class Propagator {
 public:
  Propagator(const Parameters& par, Real h, const State& z) : par_(par), h_(h), z_(z) {}

  // One step; on failure the state stays as it was.
  StepReport step() {
    State dz, rest;
    const StepReport report = solve(par_, h_, z_, carry_, dz, rest);
    if (!report.converged) return report;
    two_sum_with_rest(z_.q1, carry_.q1, dz.q1, rest.q1);
    two_sum_with_rest(z_.q2, carry_.q2, dz.q2, rest.q2);
    two_sum_with_rest(z_.p1, carry_.p1, dz.p1, rest.p1);
    two_sum_with_rest(z_.p2, carry_.p2, dz.p2, rest.p2);
    ++steps_;
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
    steps_ = 0;
  }

  [[nodiscard]] const State& state() const { return z_; }
  // What rounding took from the state: the sum of both is what the steps go on from.
  [[nodiscard]] const State& carry() const { return carry_; }
  // Since the first state.
  [[nodiscard]] Real time() const { return static_cast<Real>(steps_) * h_; }
  [[nodiscard]] Real h() const { return h_; }
  [[nodiscard]] const Parameters& parameters() const { return par_; }

 private:
  Parameters par_;
  Real h_;
  State z_;
  State carry_;
  long long steps_ = 0;
};

}  // namespace emitted_3a1842c6
}  // namespace henon_heiles::symplectic_euler_a
#elif HAMGEN_METHOD_henon_heiles_symplectic_euler_a != 0x3a1842c6
#error "another method of this name is included before: generate one with --namespace"
#endif

#ifdef __clang__
#pragma float_control(pop)
#endif
