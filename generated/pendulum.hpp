// pendulum, implicit-midpoint.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0, in C++17
//   command   hamgen generate hamiltonians/pendulum.ham
//   model     hamiltonians/pendulum.ham
//   sha256    492f143ced2b8c56ef576565398ce1c424f5eab431b84482fbae777e4bc970ad
//   H(q, p) = p^2/2 - eps*cos(q)
//   scheme    alpha = 1/2, beta = 0, gamma = 0: order 2, symmetric, symplectic
//   step      Q = q + h dH/dp, P = p - h dH/dq at qbar = (q + Q)/2, pbar = (p + P)/2
//   proved    symplectic, symmetric, order 2, emitted code
//   solve     Newton of size 1 on q; p torn out; derivatives ahead
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//             1 of the unknowns: torn out
//   cost      per iteration: 12 + - *, 1 /, 2 sqrt and functions; per step besides: 2 + - *
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

#ifndef HAMGEN_SYSTEM_pendulum
#define HAMGEN_SYSTEM_pendulum 0xd84fca51
namespace pendulum {
inline namespace emitted_d84fca51 {

using Real = double;

struct Parameters {
  Real eps = 0.03;  // strength of gravity [1/s^2]
};

struct State {
  Real q = 0.0;  // angle from the downward vertical [rad]
  Real p = 0.0;  // mass times length squared is 1 [rad/s]
};

// H(q, p).
inline Real energy(const Parameters& par, const State& z) {
  const Real q = z.q;
  const Real p = z.p;
  return 0.5 * (p * p) - par.eps * std::cos(q);
}

// grad H, the derivatives by q first.
inline void gradient(const Parameters& par, const State& z, Real (&values)[2]) {
  const Real q = z.q;
  const Real p = z.p;
  values[0] = par.eps * std::sin(q);
  values[1] = p;
}

}  // namespace emitted_d84fca51
}  // namespace pendulum
#elif HAMGEN_SYSTEM_pendulum != 0xd84fca51
#error "another system of this name is included before: generate one with --namespace"
#endif

// What follows knows nothing of the system.
#if defined __GNUC__ && !defined __clang__  // g++ warns of bounds that are a template's int
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsign-conversion"
#endif
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

#ifndef HAMGEN_9581D1FB_FLOAT64_VERDICT
#define HAMGEN_9581D1FB_FLOAT64_VERDICT
// What a stopping rule says after an iteration.
enum class Verdict { go_on, done, failed };
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_NEWTON_RULE
#define HAMGEN_9581D1FB_FLOAT64_NEWTON_RULE
// When to stop Newton's iteration: at round-off.  Increments shrink as
//   next <= contraction * size^Power,
// Power = 2 with the exact matrix, 1 with an approximate one.  The last increment still enters the
// solution, so an iteration may stop when the next one would be lost in rounding.
//
// Note [what one increment leaves]
// The contraction is measured, kept from step to step and checked at least every 32nd step.  What
// is cut off is a bias where rounding is a random walk, and in the momenta it counts 1/h times: the
// factor 2^-20 keeps it below the sum of the rounding errors.
//
// But a contraction of 32 steps ago knows nothing of a wall that has come near since, and next to
// rounding none can be measured.  The motion itself shows how curved the equations are where it is:
// in a step the solution moves by `move`, its second difference is h^2 times a force, and so
//   bend, its difference of order 2 + Power, is h^2 |force^(Power)| move^Power,
// while an increment leaves h^2 |force^(Power)| size^Power or less (an approximate matrix is taken
// to be no worse than the unit matrix), that is bend (size/move)^Power.  A step of one increment
// needs this to be lost in rounding too.  Both are those of the step before, or the increment where
// it is larger than bend, and count 2^20 times, as what is measured does: for a force that has
// grown since, for an increment across the motion, and for the bias.  Counted 2^10 times, between
// walls exp(40 (q - 1)) at h = 0.005 the energy fell by 1.9e-19 of itself in every step.  Of
// several unknowns, each in its own unit, they count 2^17 times, and where each is asked by itself
// a 2^-14th of its rounding is what an increment may leave, measured or not: the bend of a linear
// oscillation, which leaves nothing, is counted as well.  (With a 16th twelve between such walls
// lost 5e-4 of their roundings a step.)
//
// Note [what is below rounding]
// An increment below rounding ends an exact iteration.  Of an approximate one it leaves the
// contraction times itself: a hundredth of a rounding error, but the same way at every step.  Of
// Kepler's orbit (order 4, h = 0.1) the angular momentum fell by 1.6e-4 roundings a step.  Where
// that counts one more increment follows, which is made of rounding alone.
//
// Note [a prediction is followed while increments halve]
// They do where Newton and Kantorovich's theorem promises a solution, which then is not further
// away than twice the first.  A prediction that ends beyond a pole of the force wanders, and may
// come to another solution of the equations than the motion's: that is a failure, and the step is
// tried again from the state.
struct Motion {
  Real move = 0;
  Real bend = 0;
  Real least = 0;  // the least move of several unknowns
};
template <int Power>
struct NewtonRule {
  Real contraction = largest;
  int unchecked = 32;  // steps since it was measured
  Real previous = 0;   // what the last increment was
  int grown = 0;
  bool predicted = false;
  Real far = 0;        // what was uneven in the iteration before
  bool still = false;  // has it ended with noise?
  Motion motion;

  static constexpr Real tiny = 64 * epsilon / largest;  // next to the smallest number
  static Real power(Real size) { return Power == 2 ? size * size : size; }
  // From a prediction, or else from the state itself.
  void begin(bool from_prediction) {
    previous = 0;
    predicted = from_prediction;
  }
  // The solution of a step, from the unknown `first` on, before the history records it.
  template <class Past, class Solution>
  void watch(const Past& past, const Solution& solution, int first, int count) {
    motion.move = past.error(0, solution, first, count);
    motion.bend = past.error(Power + 1, solution, first, count);
  }
  // size, scale: of the increment and of the value.
  Verdict operator()(Real size, Real scale, int iterations) {
    const Real round_off = epsilon * scale;
    if (iterations == 1 && ends_at_once(size, seen_in(scale), round_off, motion.move))
      return Verdict::done;
    return judge<false>(size, scale, iterations, 0, Alone{size, scale});
  }
  // Most steps do, with their first increment: where what the motion shows, and what was measured,
  // is lost in this.
  bool ends_at_once(Real size, Real shown, Real measured, Real move) {
    const bool ends =
        unchecked < 31 && is_straight(size, shown, move) && is_next_lost(size, measured);
    unchecked += ends;
    return ends;
  }
  struct Alone {
    Real size, scale;
    bool is_within(Real units) const { return size <= units * epsilon * scale; }
    static bool is_still() { return true; }
    static bool is_in_reach() { return true; }
  };
  // The same of several unknowns, see NewtonRuleOfMany, of which it is asked whether the increments
  // are within so many units of rounding of them all, whether none converges any more, and whether
  // what its own motion shows of each is lost.
  template <bool Many, class Unknown>
  Verdict judge(Real size, Real scale, int iterations, Real uneven, const Unknown& each) {
    const Real round_off = epsilon * scale;
    still = false;
    if (!(size <= largest)) {
      previous = size;
      return Verdict::failed;
    }
    const bool first = previous <= 0;
    const bool stays = Many && !first && far > 0 && 10 * uneven > 9 * far;
    const bool waits = Power == 1 && uneven > epsilon * epsilon * round_off && !stays;
    far = uneven;
    if (first) {
      ++unchecked;
      grown = 0;
    } else {
      // Of several unknowns, of which some may be noise while others converge, increments must
      // become less by more than that.
      const Real least = Power == 2 ? 8 : 2;
      const bool slow = Many ? least * size > previous : size >= previous;
      learn(size, round_off, Many && slow);
      unchecked = 0;
      // No progress twice in a row: this is round-off if it is small, else it may still recover.
      grown = slow ? grown + 1 : 0;
      const bool small = !Many || 4096 * size <= scale;
      still = grown >= 2 && small && !waits && each.is_within(4096) && each.is_still();
      if (still) return Verdict::done;
    }
    const bool near = !Many || !first || each.is_in_reach();
    const bool serves = near && (Power == 1 ? !waits : uneven <= 0 || is_even(size, uneven));
    if (size <= round_off && is_chance(size, round_off) && (serves || stays)) return Verdict::done;
    const Real shown = Many ? 8 * round_off : seen_in(scale);
    const bool looked = !first || (unchecked < 32 && is_straight(size, shown, motion.move));
    const bool reaches = !Many || first || Power == 1 || size * size * size <= epsilon * round_off;
    if (looked && serves && reaches && is_next_lost(size, round_off)) return Verdict::done;
    const bool astray = predicted && iterations > 1 && 2 * size > previous && !each.is_within(4096);
    previous = size;
    // Noise may turn in circles and never be twice in a row what it was.
    if (Many && iterations >= 60 && each.is_within(64)) return Verdict::done;
    return iterations < 60 && !astray ? Verdict::go_on : Verdict::failed;
  }
  // It may rise at once but falls slowly: one small increment may be luck.  Of several unknowns it
  // does not rise where nothing converges.
  void learn(Real size, Real round_off, bool doubtful) {
    const Real seen = (size < round_off ? round_off : size) / power(previous);
    const bool rises = !doubtful && size > 64 * round_off && seen > contraction;
    if (contraction >= largest || rises) {
      contraction = seen < largest ? seen : largest;
    } else if (seen < contraction) {
      contraction = 4 * seen < contraction ? contraction / 4 : seen;
    }
  }
  bool is_next_lost(Real size, Real round_off) const {
    return contraction * power(size) * 1048576 <= round_off;
  }
  // See Note [what is below rounding].
  bool is_chance(Real size, Real round_off) const {
    return Power == 2 || (previous > 0 && previous <= round_off) ||
           contraction * size * 8192 <= round_off;
  }
  // Is the next increment lost in the rounding of each unknown?  See Note [what every unknown
  // lacks].
  bool is_even(Real size, Real uneven) const {
    if (previous > 0) return uneven * 16384 <= epsilon;
    const Real parts = size * uneven;
    return contraction * parts * 16384 <= epsilon &&
           bend_of(size) * parts * 16384 <= epsilon * power(motion.move);
  }
  // Is bend (size / move)^Power lost in rounding?
  bool is_straight(Real size, Real round_off, Real move) const {
    return bend_of(size) * power(size) * 1048576 <= round_off * power(move);
  }
  // What the motion shows must be lost in the rounding of a single unknown, and in that of 1024
  // times its way: a momentum that moves it may be torn out, and is rounded as that.
  Real seen_in(Real scale) const {
    const Real near = 1024 * motion.move + epsilon * scale;
    return epsilon * (near < scale ? near : scale);
  }
  // See Note [what one increment leaves].
  Real bend_of(Real size) const { return motion.bend > size ? motion.bend : size; }
};
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_HISTORY
#define HAMGEN_9581D1FB_FLOAT64_HISTORY
// Solutions of earlier steps, extrapolated by polynomials.  With s_d the prediction of degree d
// and x the solution that came, the next predictions are
//   (d + 1) x - s_0 - ... - s_(d-1).
// The degree is chosen anew every 16th step: the one that predicted best that time.  As long as
// that is one of the highest known, the next one is tried.
template <int Unknowns>
struct History {
  // Each degree is a copy of all unknowns: for many of them it must be worth its memory.
  static constexpr int degrees = Unknowns > 32 ? 8 : 16;
  Real predicted[degrees][Unknowns] = {};
  static constexpr bool many = Unknowns > 64;
  int known = 0;  // degrees that are kept up to date
  int best = 0;
  int age = 15;

  void record(const Real (&solution)[Unknowns]) {
    if (++age == 16) choose(solution);
    if constexpr (many) {
      record_each<degrees>(solution);
    } else {
      record_degrees(solution);
    }
  }
  void record_degrees(const Real (&solution)[Unknowns]) {
    Real sum[Unknowns] = {};
    for (int degree = 0; degree < known; ++degree) {
      for (int i = 0; i < Unknowns; ++i) {
        const Real kept = predicted[degree][i];
        predicted[degree][i] = Real(degree + 1) * solution[i] - sum[i];
        sum[i] += kept;
      }
    }
  }
  // Of many unknowns each is brought up to date by itself, by a constant number of degrees: what
  // its sum has reached stays in a register.
  template <int Known>
  void record_each(const Real (&solution)[Unknowns]) {
    if constexpr (Known > 0) {
      if (known < Known) return record_each<Known - 1>(solution);
      for (int i = 0; i < Unknowns; ++i) {
        Real all = 0;
        for (int degree = 0; degree < Known; ++degree) {
          const Real kept = predicted[degree][i];
          predicted[degree][i] = Real(degree + 1) * solution[i] - all;
          all += kept;
        }
      }
    }
  }
  // Seldom done, and no part of a step's code.
  __attribute__((noinline)) void choose(const Real (&solution)[Unknowns]) {
    age = 0;
    Real least = 0;
    for (int degree = 0; degree < known; ++degree) {
      const Real now = error(degree, solution, 0, Unknowns);
      if (degree == 0 || now < least) {
        least = now;
        best = degree;
      }
    }
    if (best + 2 < known) {
      --known;
    } else if (known < degrees) {
      ++known;
      age = 15;
    }
  }
  // The difference of order degree + 1 at the solution that came, of lower order if fewer steps are
  // known, and 0 if none is: summed over `count` unknowns.
  Real error(int degree, const Real (&solution)[Unknowns], int first, int count) const {
    Real sum_of_errors = 0;
    int i = first;
    if constexpr (many) {
      // In parts that do not wait for each other.
      Real parts[8] = {};
      for (; i + 8 <= first + count; i += 8) {
        for (int k = 0; k < 8; ++k) parts[k] += difference(degree, solution, i + k);
      }
      for (const Real part : parts) sum_of_errors += part;
    }
    for (; i < first + count; ++i) sum_of_errors += difference(degree, solution, i);
    return sum_of_errors;
  }
  // The same of one unknown.
  template <class Solution>
  Real difference(int degree, const Solution& solution, int i) const {
    if (known == 0) return 0;
    return magnitude(solution[i] - predicted[degree < known ? degree : known - 1][i]);
  }
  // The way of one unknown since the last step.
  template <class Solution>
  Real way(const Solution& solution, int i) const {
    return known == 0 ? Real(0) : solution[i] - predicted[0][i];
  }
  void extrapolate(Real (&solution)[Unknowns]) const {
    for (int i = 0; i < Unknowns; ++i) solution[i] = predicted[best][i];
  }
};
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_FORGET
#define HAMGEN_9581D1FB_FLOAT64_FORGET
// As if no step had been recorded, in place: a large History makes no temporary on the stack.
template <int Unknowns>
void forget(History<Unknowns>& history) {
  history.known = 0;
  history.best = 0;
  history.age = 15;
}
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_AHEAD
#define HAMGEN_9581D1FB_FLOAT64_AHEAD
// What the polynomial that predicts the next solution says of the one after it: with s_d the next
// one's predictions and D the degree it is taken of,
//   (D + 1) s_D - s_0 - ... - s_(D-1),
// which is how History goes on where s_D itself is the solution that comes.
template <int Unknowns>
void extrapolate_twice(const History<Unknowns>& history, Real (&solution)[Unknowns]) {
  for (int i = 0; i < Unknowns; ++i) {
    Real sum = 0;
    for (int degree = 0; degree < history.best; ++degree) sum += history.predicted[degree][i];
    solution[i] = Real(history.best + 1) * history.predicted[history.best][i] - sum;
  }
}
#endif

}  // namespace hamgen_9581d1fb::float64
#if defined __GNUC__ && !defined __clang__
#pragma GCC diagnostic pop
#endif

#ifndef HAMGEN_METHOD_pendulum_implicit_midpoint
#define HAMGEN_METHOD_pendulum_implicit_midpoint 0x6a692492
namespace pendulum::implicit_midpoint {
inline namespace emitted_6a692492 {

namespace numerics = ::hamgen_9581d1fb::float64;
using numerics::StepReport, numerics::magnitude, numerics::two_sum_with_rest, numerics::Verdict,
    numerics::NewtonRule, numerics::History, numerics::forget, numerics::extrapolate_twice;

// What depends on h and the parameters alone.
struct Coefficients {
  Real c1 = 0.0;  // -h/2
};

inline Coefficients prepare(const Parameters&, Real h) {
  Coefficients k;
  k.c1 = -0.5 * h;
  return k;
}

// Start values of the implicit equations and what is remembered of their solution.
struct Start {
  Real value[1] = {};
  bool known = false;  // else the state itself is the start
  NewtonRule<2> rule_0;
};

// Derivatives of H, and what they consist of, at a point.
struct Derivatives {
  Real point[1] = {};
  bool ready = false;  // are the others those at the point?
  Real H_q = 0.0;
  Real H_q_q = 0.0;
};

// Those at at.point.
inline void derivatives(const Parameters& par, Derivatives& at) {
  const Real q_bar = at.point[0];
  const Real H_q = par.eps * std::sin(q_bar);
  const Real H_q_q = par.eps * std::cos(q_bar);
  at.H_q = H_q;
  at.H_q_q = H_q_q;
}

// dz + rest = Z - z for one step from z + carry; rest is small.
[[nodiscard, gnu::always_inline]] inline StepReport solve(const Parameters& par,
                                                          const Coefficients& k, Real h,
                                                          const State& z, const State& carry,
                                                          Start& start, Derivatives& at, State& dz,
                                                          State& rest) {
  StepReport report;
  const Real q = z.q;
  const Real p = z.p;
  Real p_bar = 0.0;
  Real delta_q = 0.0;
  Real q_bar = start.known ? start.value[0] : q;
  // Newton's iteration for the stage values: residual R, its derivatives, increments delta.
  start.rule_0.begin(start.known);
  for (int iteration = 1;; ++iteration) {
    if (at.ready) q_bar = at.point[0];
    if (!at.ready) {
      at.point[0] = q_bar;
      derivatives(par, at);
    }
    at.ready = false;
    const Real rest_p = carry.p + k.c1 * at.H_q;
    p_bar = p + rest_p;
    const Real d_p_d_q = k.c1 * at.H_q_q;
    const Real q_gap = q_bar - q;
    const Real q_gap_1 = q_gap + p_bar * k.c1;
    const Real R_q = -(carry.q - q_gap_1);
    const Real R_q_q = 1.0 + k.c1 * d_p_d_q;
    delta_q = -R_q / R_q_q;
    const Real size = magnitude(delta_q);
    const Real scale = magnitude(q_bar) + magnitude(q);
    const Verdict verdict = start.rule_0(size, scale, iteration);
    if (verdict == Verdict::failed) {
      report.iterations += iteration;
      report.increment = start.rule_0.previous;
      return report;
    }
    if (verdict == Verdict::done) {
      report.iterations += iteration;
      break;
    }
    q_bar += delta_q;
  }
  start.value[0] = q_bar + delta_q;
  // The last increments correct the gradient to first order: no evaluation at the solution.
  const Real change_H_q = delta_q * at.H_q_q;
  const Real change_H_p = k.c1 * change_H_q;
  dz.q = h * p_bar;
  rest.q = carry.q + h * change_H_p;
  dz.p = -h * at.H_q;
  rest.p = carry.p - h * change_H_q;
  // False for infinities and NaN alike.
  const Real length = (dz.q + rest.q) * (dz.q + rest.q) + (dz.p + rest.p) * (dz.p + rest.p);
  report.converged = length <= 1.0e308;
  if (!report.converged) report.increment = length;
  return report;
}

// Advances z by one step of size h.  On failure z is left unchanged.
[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {
  const Coefficients k = prepare(par, h);
  Start start;
  Derivatives at;
  State dz, rest;
  const StepReport report = solve(par, k, h, z, State(), start, at, dz, rest);
  if (!report.converged) return report;
  z.q += dz.q + rest.q;
  z.p += dz.p + rest.p;
  return report;
}

// Many steps: start values are extrapolated, rounding errors of the updates carried along.
class Propagator {
 public:
  Propagator(const Parameters& par, Real h, const State& z)
      : par_(par), h_(h), z_(z), k_(prepare(par, h)) {}

  // One step; on failure the state stays as it was.
  StepReport step() {
    State dz, rest;
    start_.known = history_.known > 0;
    if (start_.known) history_.extrapolate(start_.value);
    StepReport report = solve(par_, k_, h_, z_, carry_, start_, at_, dz, rest);
    if (!report.converged && start_.known) {
      // Extrapolation may lead astray, the state itself seldom does.
      const long long wasted = report.iterations;
      start_ = Start();
      report = solve(par_, k_, h_, z_, carry_, start_, at_, dz, rest);
      report.iterations += wasted;
    }
    if (!report.converged) return report;
    start_.rule_0.watch(history_, start_.value, 0, 1);
    // What the next step takes of H is evaluated where the solutions before this one predict it:
    // nothing of that waits for this step.
    if (start_.known) {
      extrapolate_twice(history_, at_.point);
      derivatives(par_, at_);
      at_.ready = true;
    }
    history_.record(start_.value);
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
    start_ = Start();
    at_ = Derivatives();
    forget(history_);
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
  Start start_;
  Derivatives at_;
  History<1> history_;
};

}  // namespace emitted_6a692492
}  // namespace pendulum::implicit_midpoint
#elif HAMGEN_METHOD_pendulum_implicit_midpoint != 0x6a692492
#error "another method of this name is included before: generate one with --namespace"
#endif

#ifdef __clang__
#pragma float_control(pop)
#endif
