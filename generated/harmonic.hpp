// harmonic, implicit-midpoint.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0, in C++17
//   command   hamgen generate hamiltonians/harmonic.ham
//   model     hamiltonians/harmonic.ham
//   sha256    fcf2f89f040617f03f5a8147fa7f74832e9c455dee8e25aad6dcde9e54458dc6
//   H(q, p) = p^2/2 + w^2*q^2/2
//   scheme    alpha = 1/2, beta = 0, gamma = 0: order 2, symmetric, symplectic
//   step      Q = q + h dH/dp, P = p - h dH/dq at qbar = (q + Q)/2, pbar = (p + P)/2
//   proved    symplectic, symmetric, order 2, emitted code
//   solve     linear solve of size 2 for q, p, constant matrix hoisted
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//   cost      per step: 88 + - *
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

#ifndef HAMGEN_SYSTEM_harmonic
#define HAMGEN_SYSTEM_harmonic 0xe14d7609
namespace harmonic {
inline namespace emitted_e14d7609 {

using Real = double;

struct Parameters {
  Real w = 1.0;  // angular frequency
};

struct State {
  Real q = 0.0;
  Real p = 0.0;
};

// H(q, p).
inline Real energy(const Parameters& par, const State& z) {
  const Real q = z.q;
  const Real p = z.p;
  return 0.5 * (p * p + par.w * par.w * (q * q));
}

// grad H, the derivatives by q first.
inline void gradient(const Parameters& par, const State& z, Real (&values)[2]) {
  const Real q = z.q;
  const Real p = z.p;
  values[0] = q * (par.w * par.w);
  values[1] = p;
}

}  // namespace emitted_e14d7609
}  // namespace harmonic
#elif HAMGEN_SYSTEM_harmonic != 0xe14d7609
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

#ifndef HAMGEN_9581D1FB_FLOAT64_VOCABULARY
#define HAMGEN_9581D1FB_FLOAT64_VOCABULARY
inline Real magnitude(Real x) { return std::fabs(x); }
inline constexpr Real largest = 1.0e308;  // what is beyond counts as infinite
inline constexpr Real epsilon = 0x1p-52;  // the distance from 1 to the next number
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

#ifndef HAMGEN_9581D1FB_FLOAT64_PRODUCT_ERROR
#define HAMGEN_9581D1FB_FLOAT64_PRODUCT_ERROR
// x * y less its rounded value, by Dekker's product of halves: exact without a fused multiply-add,
// unless `splitter` times one of them overflows.
inline Real product_error(Real x, Real y) {
  constexpr auto find_splitter = [] {
    Real power = 1;
    while (power * power * epsilon < 2) power *= 2;
    return power + 1;
  };
  constexpr Real splitter = find_splitter();
  const Real large_x = splitter * x;
  const Real large_y = splitter * y;
  const Real x_hi = large_x - (large_x - x);
  const Real y_hi = large_y - (large_y - y);
  const Real x_lo = x - x_hi;
  const Real y_lo = y - y_hi;
  return x_lo * y_lo - (((x * y - x_hi * y_hi) - x_lo * y_hi) - x_hi * y_lo);
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

#ifndef HAMGEN_METHOD_harmonic_implicit_midpoint
#define HAMGEN_METHOD_harmonic_implicit_midpoint 0xbb0de341
namespace harmonic::implicit_midpoint {
inline namespace emitted_bb0de341 {

namespace numerics = ::hamgen_9581d1fb::float64;
using numerics::StepReport, numerics::two_sum_with_rest, numerics::product_error,
    numerics::difference_error;

// What depends on h and the parameters alone.
struct Coefficients {
  Real c1 = 0.0;  // w^2
  Real c2 = 0.0;  // h*w^2/2
  Real c3 = 0.0;  // 1/(1 + h^2*w^2/4)
  Real c4 = 0.0;  // h/2/(1 + h^2*w^2/4)
  Real c5 = 0.0;  // -h*w^2/2/(1 + h^2*w^2/4)
  Real c6 = 0.0;  // h/(1 + h^2*w^2/4)
  Real c7 = 0.0;  // -h^2*w^2/2/(1 + h^2*w^2/4)
  Real c8 = 0.0;  // h*w^2/(1 + h^2*w^2/4)
  Real c9 = 0.0;  // h^2*w^2/2/(1 + h^2*w^2/4)
};

inline Coefficients prepare(const Parameters& par, Real h) {
  Coefficients k;
  k.c1 = par.w * par.w;
  k.c2 = 0.5 * h * k.c1;
  k.c3 = 1.0 / (1.0 + 0.5 * h * k.c2);
  k.c4 = 0.5 * h * k.c3;
  k.c5 = -k.c3 * k.c2;
  k.c6 = h * k.c3;
  k.c7 = h * k.c5;
  k.c8 = h * k.c3 * k.c1;
  k.c9 = h * k.c4 * k.c1;
  return k;
}

// dz + rest = Z - z for one step from z + carry; rest is small.
[[nodiscard]] inline StepReport solve(const Parameters&, const Coefficients& k, Real h,
                                      const State& z, const State& carry, State& dz, State& rest) {
  StepReport report;
  const Real q = z.q;
  const Real p = z.p;
  const Real q_bar = q * k.c3 + p * k.c4;
  const Real p_bar = q * k.c5 + p * k.c3;
  const Real H_q = q_bar * k.c1;
  const Real lost_w_2_bar_q = product_error(k.c1, q_bar);
  const Real h_H_p = h * p_bar;
  const Real lost_h_H_p = product_error(h, p_bar);
  const Real q_gap = q_bar - q;
  const Real q_gap_error = difference_error(q_bar, q);
  const Real q_gap_1 = -(0.5 * h_H_p - q_gap);
  const Real rest_beside_q = carry.q + 0.5 * lost_h_H_p - q_gap_error;
  const Real R_q = q_gap_1 - rest_beside_q;
  const Real h_H_q = h * H_q;
  const Real lost_h_H_q = product_error(h, H_q);
  const Real lost_h_H_q_in_all = lost_h_H_q + h * lost_w_2_bar_q;
  const Real p_gap = p_bar - p;
  const Real p_gap_error = difference_error(p_bar, p);
  const Real p_gap_1 = 0.5 * h_H_q + p_gap;
  const Real rest_beside_p = carry.p - 0.5 * lost_h_H_q_in_all - p_gap_error;
  const Real R_p = p_gap_1 - rest_beside_p;
  dz.q = h_H_p;
  rest.q = carry.q + lost_h_H_p - k.c6 * R_p - k.c7 * R_q;
  dz.p = -h_H_q;
  rest.p = carry.p - lost_h_H_q_in_all + k.c8 * R_q + k.c9 * R_p;
  // False for infinities and NaN alike.
  const Real length = (dz.q + rest.q) * (dz.q + rest.q) + (dz.p + rest.p) * (dz.p + rest.p);
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
  z.p += dz.p + rest.p;
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
    two_sum_with_rest(z_.p, carry_.p, dz.p, rest.p);
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
  Coefficients k_;
};

}  // namespace emitted_bb0de341
}  // namespace harmonic::implicit_midpoint
#elif HAMGEN_METHOD_harmonic_implicit_midpoint != 0xbb0de341
#error "another method of this name is included before: generate one with --namespace"
#endif

#ifdef __clang__
#pragma float_control(pop)
#endif
