// product, symplectic-euler-b.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0, in C++17
//   command   hamgen generate hamiltonians/product.ham --scheme symplectic-euler-b
//   model     hamiltonians/product.ham
//   sha256    827ad3095c58c92aea25a81d74b660a8b7ea95a923c7be1f99858ea7e4361d88
//   H(q, p) = (q^2 + 1)*(p^2 + 1)/2
//   scheme    alpha = 1, beta = 0, gamma = 0: order 1, symplectic
//   step      Q = q + h dH/dp, P = p - h dH/dq at qbar = Q, pbar = p
//   proved    symplectic, order 1, emitted code
//   refuted   symmetric
//   solve     quadratic equation for q, root in closed form
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//   cost      per step: 23 + - *, 1 /, 1 sqrt and functions
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

#ifndef HAMGEN_SYSTEM_product
#define HAMGEN_SYSTEM_product 0xf687030d
namespace product {
inline namespace emitted_f687030d {

using Real = double;

struct Parameters {};

struct State {
  Real q = 0.0;
  Real p = 0.0;
};

// H(q, p).
inline Real energy(const Parameters&, const State& z) {
  const Real q = z.q;
  const Real p = z.p;
  return 0.5 * (1.0 + q * q) * (1.0 + p * p);
}

// grad H, the derivatives by q first.
inline void gradient(const Parameters&, const State& z, Real (&values)[2]) {
  const Real q = z.q;
  const Real p = z.p;
  values[0] = q * (1.0 + p * p);
  values[1] = p * (1.0 + q * q);
}

}  // namespace emitted_f687030d
}  // namespace product
#elif HAMGEN_SYSTEM_product != 0xf687030d
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

}  // namespace hamgen_9581d1fb::float64

#ifndef HAMGEN_METHOD_product_symplectic_euler_b
#define HAMGEN_METHOD_product_symplectic_euler_b 0x70c4c261
namespace product::symplectic_euler_b {
inline namespace emitted_70c4c261 {

namespace numerics = ::hamgen_9581d1fb::float64;
using numerics::StepReport, numerics::two_sum;

// What depends on h and the parameters alone.
struct Coefficients {
  Real c1 = 0.0;  // -2*h
};

inline Coefficients prepare(const Parameters&, Real h) {
  Coefficients k;
  k.c1 = -2.0 * h;
  return k;
}

// dz = Z - z for one step from z + carry.
[[nodiscard]] inline StepReport solve(const Parameters&, const Coefficients& k, Real h,
                                      const State& z, const State& carry, State& dz) {
  StepReport report;
  const Real q = z.q;
  const Real p = z.p;
  const Real p_bar = p + carry.p;
  const Real c0_q = -(carry.q + h * p_bar * (1.0 + q * q));
  const Real c1_q = 1.0 + q * p_bar * k.c1;
  const Real c2_q = -h * p_bar;
  const Real q_bar = q - 2.0 * c0_q / (c1_q + std::sqrt(c1_q * c1_q - 4.0 * c0_q * c2_q));
  const Real H_p = p_bar * (1.0 + q_bar * q_bar);
  const Real H_q = q_bar * (1.0 + p_bar * p_bar);
  dz.q = carry.q + h * H_p;
  dz.p = carry.p - h * H_q;
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
  const StepReport report = solve(par, k, h, z, State(), dz);
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
    const StepReport report = solve(par_, k_, h_, z_, carry_, dz);
    if (!report.converged) return report;
    two_sum(z_.q, carry_.q, dz.q);
    two_sum(z_.p, carry_.p, dz.p);
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

}  // namespace emitted_70c4c261
}  // namespace product::symplectic_euler_b
#elif HAMGEN_METHOD_product_symplectic_euler_b != 0x70c4c261
#error "another method of this name is included before: generate one with --namespace"
#endif

#ifdef __clang__
#pragma float_control(pop)
#endif
