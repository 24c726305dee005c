// kepler, implicit-midpoint.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0, in C++17
//   command   hamgen generate hamiltonians/kepler.ham
//   model     hamiltonians/kepler.ham
//   sha256    7274355e6771529febcf6c1d9ce184fa3ab1b756eb8d31c58ffb9e707199c4e2
//   H(q, p) = (p1^2 + p2^2)/2 - 1/r
//   r = sqrt(q1^2 + q2^2)
//   scheme    alpha = 1/2, beta = 0, gamma = 0: order 2, symmetric, symplectic
//   step      Q = q + h dH/dp, P = p - h dH/dq at qbar = (q + Q)/2, pbar = (p + P)/2
//   proved    symplectic, symmetric, order 2, conserves L, emitted code
//   solve     Newton of size 2 on q1, q2; p1, p2 torn out
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//             parameters e: the step does not use them
//             2 of the unknowns: torn out
//   cost      per iteration: 52 + - *, 2 /, 1 sqrt and functions; per step besides: 8 + - *
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

#ifndef HAMGEN_SYSTEM_kepler
#define HAMGEN_SYSTEM_kepler 0x7a10292d
namespace kepler {
inline namespace emitted_7a10292d {

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
  const Real t1 = std::sqrt(q1 * q1 + q2 * q2);
  return 0.5 * (p1 * p1) + 0.5 * (p2 * p2) - 1.0 / t1;
}

// grad H, the derivatives by q first.
inline void gradient(const Parameters&, const State& z, Real (&values)[4]) {
  const Real q1 = z.q1;
  const Real q2 = z.q2;
  const Real p1 = z.p1;
  const Real p2 = z.p2;
  const Real t1 = 1.0 / (q1 * q1 + q2 * q2);
  const Real t2 = std::sqrt(q1 * q1 + q2 * q2);
  const Real t3 = t1 * t2;
  const Real t4 = t1 * t3;
  values[0] = q1 * t4;
  values[1] = q2 * t4;
  values[2] = p1;
  values[3] = p2;
}

// The model's invariants: L, A1, A2.
inline void invariants(const Parameters&, const State& z, Real (&values)[3]) {
  const Real q1 = z.q1;
  const Real q2 = z.q2;
  const Real p1 = z.p1;
  const Real p2 = z.p2;
  const Real t1 = q1 * p2 - q2 * p1;
  const Real t2 = std::sqrt(q1 * q1 + q2 * q2);
  const Real t3 = 1.0 / t2;
  values[0] = t1;
  values[1] = -(q1 * t3 - p2 * t1);
  values[2] = -(q2 * t3 + p1 * t1);
}

}  // namespace emitted_7a10292d
}  // namespace kepler
#elif HAMGEN_SYSTEM_kepler != 0x7a10292d
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

#ifndef HAMGEN_9581D1FB_FLOAT64_NEWTON_RULE_OF_MANY
#define HAMGEN_9581D1FB_FLOAT64_NEWTON_RULE_OF_MANY
// NewtonRule of several unknowns.
//
// Note [units]
// Nothing may hang on the units in which they are written: sums of what is 1e-5 in one unknown and
// 1 in another do not see the wall that the first runs into, and were off by 5e6 roundings.  So
// increments are added as parts of the sizes that their unknowns have had.  In every 16th step a
// size is taken anew where its unknown has become more than twice as large, and is a 32nd where
// that is less than a 2^-10th of it.  The first one is the unknown and 32 times what it moves by,
// so that it may begin at zero, and at least a 2^-40th of all together.  In what is as small,
// rounding errors of the others may be most of an increment: whether it may be noise is asked of
// plain sums, and what an iteration has ended with as noise is 64 roundings of a size from then on.
//
// Note [what its own motion shows of each]
// A sum is loud where most of it is: a free particle goes a 30th in a step, and nothing in it shows
// that another one comes to a wall exp(1e5 (y - 1)) with a 1e5th.  So each unknown is also asked by
// itself whether its bend (increment / move)^2 is lost, a 2^-14th of its rounding at most, with the
// increment for the bend where that is larger, and as long as it is more than noise can be.  Where
// increments were measured the next one of each is told by its own last two, moved (moved /
// before)^2, and no step ends with noise as long as an unknown converges.  Walls beside a loud
// coordinate were off by 8000 roundings, an x that falls by 1e4 times within its size by 290, what
// is a 1e13th of its neighbour by 1e17.
//
// In the first four steps, of which no motion is known, the first increment is that of the motion,
// and tells nothing of what moves together: of pairs in free flight the next one was told to be
// lost, and their distance was off by up to 1e6.  There an increment must be lost itself, and none
// ends a step as the first.  Nor may the contraction that is seen be believed where it is next to
// none: a pair that moves as a whole shows 1e-9, and what begins at zero, as long as its size is
// taken to be far too small, is most of the sum and as linear; the pair's own swings, 1 to 10,
// were off by 6e7 and by 800 roundings.  So it is a 2^-10th at least: with the matrix, which shows
// what is curved, in those steps alone, and else in all.  Nor does what follows a first increment
// tell the contraction of a swing, where that was of the pair: it must be less than epsilon^(2/3).
//
// Note [what every unknown lacks]
// Where a step moves by the gradient of the last iteration and H'' times the increment, what is of
// second order stays where it is: a bead at rest whose neighbour is hit was off by 57 roundings. Of
// each the first increment is taken to leave the same part as all together; `uneven` is the sum of
// what the increments are of their unknowns, or what is told to follow them.  With an approximate
// matrix that would be wrong: an unknown that is small beside the others may contract far more
// slowly, and was off by 2e4 of its roundings.  `uneven` is then the sum of the increments beyond 8
// roundings of their own unknowns, and none may be left, as long as they become smaller.
//
// Nor is it enough that an increment is lost in the rounding of its unknown: a coordinate that
// hardly moves is moved by a momentum of 1/h times its way, which is torn out of the equations and
// asked by nobody.  Of beads between walls, close to their turning points, momenta were off by 76
// of their roundings.  So 16 times the way that the step has moved it stands for its length where
// that is less (a 2^-10th of a rounding of the momentum then), and one rounding of its length, for
// what never moves: a 2^-20th of it was as if something 1e12 times as heavy as what it is hit by
// had no momentum.
//
template <int Power, int Unknowns>
struct NewtonRuleOfMany : NewtonRule<Power> {
  using One = NewtonRule<Power>;
  Real unit[Unknowns] = {};   // one over the size of each, see Note [units]; 0: not known yet
  Real moves[Unknowns] = {};  // the motion of each, as it is written
  Real bends[Unknowns] = {};
  Real before[Unknowns] = {};  // by how much each moved in the iteration before
  int age = 0;
  int fresh = 4;  // steps until the motion is known

  static constexpr Real smallest = 1 / largest / (epsilon * epsilon * epsilon);

  // A first increment that is beyond the unknown may have gone astray.
  static Real size_of(Real length, Real moved) {
    const Real value = magnitude(length);
    const Real by = magnitude(moved);
    return value + 32 * (value > 0 && value < by ? value : by);
  }
  // The sizes, from a first iteration.
  void know(const Real* length, const Real* moved, int count) {
    if (!(unit[0] > 0)) begin_with(length, moved, count);
  }
  // These are seldom done, and no part of a step's code.
  __attribute__((noinline)) void begin_with(const Real* length, const Real* moved, int count) {
    Real total = 0;
    for (int j = 0; j < count; ++j) total += size_of(length[j], moved[j]);
    if (!(total > 0 && total <= largest)) return;
    for (int j = 0; j < count; ++j)
      unit[j] = 1 / (size_of(length[j], moved[j]) + total / 1099511627776 + smallest);
  }
  // Where a size is another one, the contraction is measured anew in the next step.
  __attribute__((noinline)) void follow(const Real* value, int count) {
    age = 0;
    Real least = unit[0];
    for (int j = 1; j < count; ++j) least = unit[j] < least ? unit[j] : least;
    for (int j = 0; j < count; ++j) {
      const Real part = magnitude(value[j]) * unit[j];
      const bool falls = part > 0 && 1024 * part < 1 && unit[j] < 1099511627776 * least;
      if (part <= 2 && !falls) continue;
      unit[j] = falls ? 32 * unit[j] : 1 / magnitude(value[j]);
      this->unchecked = 32;
    }
  }
  // A step more is known, which has come to these values.
  void notice(const Real* value, int count) {
    if (++age >= 16) follow(value, count);
    if (fresh <= 0) return;
    --fresh;
    this->unchecked += 32;
    doubt();
  }
  // Less is not believed.
  void doubt() {
    if (Power == 2 && 1024 * this->contraction < 1) this->contraction = Real(1) / 1024;
  }
  // The solution of a step, from the unknown `first` on, before the history records it.
  template <class Past, class Solution>
  void watch(const Past& past, const Solution& solution, int first, int count) {
    notice(&solution[first], count);
    Real move = 0;
    Real bend = 0;
    Real slowest = largest;
    for (int j = 0; j < count; ++j) {
      moves[j] = past.difference(0, solution, first + j);
      bends[j] = past.difference(Power + 1, solution, first + j);
      const Real part = moves[j] * unit[j];
      move += part;
      bend += bends[j] * unit[j];
      slowest = part < slowest ? part : slowest;
    }
    this->motion = {move, bend, slowest};
    doubt();
  }
  // See Note [what its own motion shows of each].
  bool is_in_reach(const Real* moved, const Real* length, const Real* way, int count) const {
    for (int j = 0; j < count && Power == 2; ++j) {
      const Real part = moved[j] * unit[j];
      const Real move = moves[j] * unit[j];
      const Real shown = bends[j] * unit[j];
      const Real bend = shown > part ? shown : part;
      const Real round_off = epsilon * felt(magnitude(length[j]), way[j]) * unit[j];
      // Noise is 64 roundings of a size, see `hear`, and its fourth difference 16 times as much.
      if (bend <= 1024 * epsilon) continue;
      if (bend * part * part * 16384 > round_off * move * move) return false;
    }
    return true;
  }
  // An increment as a part of what it must be lost in, or what the next one is of that, if it is no
  // noise; nothing at the smallest numbers.  Of an approximate matrix the increment, if it is not
  // lost in the rounding of its unknown.
  Real relative(int j, Real moved, Real length, Real way) const {
    if (Power == 1) return moved > 8 * epsilon * length + One::tiny ? moved : Real(0);
    if (!(moved > One::tiny)) return 0;
    if (this->previous <= 0) return moved / felt(length, way);
    if (moved * unit[j] <= 64 * epsilon) return 0;
    if (fresh > 0) return moved / felt(length, way);
    const Real ratio = moved / before[j];
    return moved / felt(length, way) * ratio * ratio;
  }
  // Of its length and its way in the step.
  static Real felt(Real length, Real way) {
    const Real least = 16 * way + epsilon * length;
    return Power == 2 && least < length ? least : length;
  }
  // Is even what all unknowns together move by lost in the rounding of one?  The least of them
  // answers for all: no more need be asked.
  bool is_lost_in(Real length, Real size) const {
    if (Power == 1) return size <= 8 * epsilon * length;
    return this->contraction * size * size * 16384 <= epsilon * length;
  }
  // The same of what the motion shows.
  bool bends_little(Real length, Real size) const {
    const Real bend = this->bend_of(size);
    return Power == 1 ||
           bend * size * size * 16384 <= epsilon * length * One::power(this->motion.move);
  }
  // By how much each unknown moves, the length that it is rounded with, and its way in the step, or
  // the lengths again where no way counts.
  Verdict of_each(const Real* moved, const Real* length, const Real* way, int count,
                  int iterations) {
    const Seen seen = sums_of(moved, length, way, count);
    // What is 2^14 times lost in the rounding of the least unknown is 2^20 times lost in 2^6 times
    // it: with the factor of ends_at_once.
    const Real round_off = epsilon * Real(count);
    const Real least = 64 * epsilon * seen.shortest;
    const Real shown = Power == 2 && least < 8 * round_off ? least : 8 * round_off;
    const Real measured = Power == 2 && least < round_off ? least : round_off;
    const bool even = Power == 2 || is_lost_in(seen.shortest, seen.size);
    // Of each the same where it is so of the one that moves least.
    const Real move = Power == 2 ? this->motion.least : this->motion.move;
    if (iterations == 1 && even && this->ends_at_once(seen.size, shown, measured, move))
      return Verdict::done;
    return judge_each(seen, moved, length, way, count, iterations);
  }
  struct Seen {
    Real size, shortest;
  };
  Seen sums_of(const Real* moved, const Real* length, const Real* way, int count) const {
    Real size = moved[0] * unit[0];
    Real least = length[0] * unit[0];
    Real nearest = way[0] * unit[0];
    for (int j = 1; j < count; ++j) {
      size += moved[j] * unit[j];
      const Real part = length[j] * unit[j];
      least = part < least ? part : least;
      const Real gone = way[j] * unit[j];
      nearest = gone < nearest ? gone : nearest;
    }
    return {size, way == length ? least : felt(least, nearest)};
  }
  __attribute__((noinline)) Verdict judge_each(Seen seen, const Real* moved, const Real* length,
                                               const Real* way, int count, int iterations) {
    if (!(unit[0] > 0)) {
      begin_with(length, moved, count);
      seen = sums_of(moved, length, way, count);
    }
    Real uneven = 0;
    // What this step has measured is not known yet where there is something to measure.
    const bool asked = Power == 1 || this->previous <= 0;
    const bool lost =
        asked && bends_little(seen.shortest, seen.size) && is_lost_in(seen.shortest, seen.size);
    if (!lost) {
      for (int j = 0; j < count; ++j) {
        uneven += relative(j, moved[j], length[j], way[j]) * (Power == 1 ? unit[j] : Real(1));
      }
    }
    Real together = moved[0];
    Real scale = length[0];
    for (int j = 1; j < count; ++j) {
      together += moved[j];
      scale += length[j];
    }
    return judge_all(seen.size, uneven, {*this, moved, length, way, count, together, scale},
                     iterations);
  }
  // Increments, lengths, ways, and sums of the first two.
  struct Each {
    const NewtonRuleOfMany& rule;
    const Real* moved;
    const Real* length;
    const Real* way;
    int count;
    Real together, scale;
    bool is_within(Real units) const { return together <= units * epsilon * scale; }
    bool is_in_reach() const { return rule.is_in_reach(moved, length, way, count); }
    bool is_still() const {
      bool converging = false;
      for (int j = 0; j < count; ++j) {
        const Real by = magnitude(moved[j]);
        converging =
            converging || (by > 8 * epsilon * magnitude(length[j]) && 2 * by <= rule.before[j]);
      }
      return !converging;
    }
  };
  Verdict judge_all(Real size, Real uneven, const Each& each, int iterations) {
    const Verdict verdict =
        this->template judge<true>(size, Real(each.count), iterations, uneven, each);
    if (this->still) hear(each.moved, each.count);
    if (verdict == Verdict::go_on)
      for (int j = 0; j < each.count; ++j) before[j] = magnitude(each.moved[j]);
    return verdict;
  }
  // Noise of rounding is no more than 64 roundings of a size: what an iteration has ended with.
  __attribute__((noinline)) void hear(const Real* moved, int count) {
    for (int j = 0; j < count; ++j) {
      const Real noise = magnitude(moved[j]);
      if (noise * unit[j] > 64 * epsilon) unit[j] = 64 * epsilon / noise;
    }
  }
  // Of values and increments in arrays, and sums over the unknowns: of increments as parts of
  // sizes, of what is relative of each, of increments and of lengths.
  Verdict of_sums(const Real* value, const Real* increment, Real size, Real uneven, Real moved,
                  Real scale, int count, int iterations) {
    return judge_all(size, uneven, {*this, increment, value, moves, count, moved, scale},
                     iterations);
  }
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

}  // namespace hamgen_9581d1fb::float64
#if defined __GNUC__ && !defined __clang__
#pragma GCC diagnostic pop
#endif

#ifndef HAMGEN_METHOD_kepler_implicit_midpoint
#define HAMGEN_METHOD_kepler_implicit_midpoint 0x9623af6a
namespace kepler::implicit_midpoint {
inline namespace emitted_9623af6a {

namespace numerics = ::hamgen_9581d1fb::float64;
using numerics::StepReport, numerics::magnitude, numerics::two_sum_with_rest, numerics::Verdict,
    numerics::NewtonRuleOfMany, numerics::History, numerics::forget;

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
  Real value[2] = {};
  bool known = false;  // else the state itself is the start
  NewtonRuleOfMany<2, 2> rule_0;
};

// dz + rest = Z - z for one step from z + carry; rest is small.
[[nodiscard, gnu::always_inline]] inline StepReport solve(const Parameters&, const Coefficients& k,
                                                          Real h, const State& z,
                                                          const State& carry, Start& start,
                                                          State& dz, State& rest) {
  StepReport report;
  const Real q1 = z.q1;
  const Real q2 = z.q2;
  const Real p1 = z.p1;
  const Real p2 = z.p2;
  Real H_q1 = 0.0;
  Real p1_bar = 0.0;
  Real H_q1_q1 = 0.0;
  Real H_q1_q2 = 0.0;
  Real H_q2 = 0.0;
  Real p2_bar = 0.0;
  Real H_q2_q2 = 0.0;
  Real delta_q1 = 0.0;
  Real delta_q2 = 0.0;
  Real q1_bar = start.known ? start.value[0] : q1;
  Real q2_bar = start.known ? start.value[1] : q2;
  // Newton's iteration for the stage values: residual R, its derivatives, increments delta.
  start.rule_0.begin(start.known);
  for (int iteration = 1;; ++iteration) {
    const Real t1 = q1_bar * q1_bar;
    const Real t2 = q2_bar * q2_bar;
    const Real t3 = t1 + t2;
    const Real t4 = 1.0 / t3;
    const Real t5 = std::sqrt(t3);
    const Real t6 = t4 * t5;
    const Real t7 = t4 * t6;
    H_q1 = q1_bar * t7;
    const Real rest_p1 = carry.p1 + k.c1 * H_q1;
    p1_bar = p1 + rest_p1;
    const Real t8 = t4 * t4;
    const Real t9 = t6 * t8;
    H_q1_q1 = t7 - 3.0 * t1 * t9;
    const Real d_p1_d_q1 = k.c1 * H_q1_q1;
    H_q1_q2 = -3.0 * q1_bar * q2_bar * t9;
    const Real d_p1_d_q2 = k.c1 * H_q1_q2;
    H_q2 = q2_bar * t7;
    const Real rest_p2 = carry.p2 + k.c1 * H_q2;
    p2_bar = p2 + rest_p2;
    H_q2_q2 = t7 - 3.0 * t2 * t9;
    const Real d_p2_d_q2 = k.c1 * H_q2_q2;
    const Real q1_gap = q1_bar - q1;
    const Real q1_gap_1 = q1_gap + p1_bar * k.c1;
    const Real q2_gap = q2_bar - q2;
    const Real q2_gap_1 = q2_gap + p2_bar * k.c1;
    const Real R_q1 = -(carry.q1 - q1_gap_1);
    const Real R_q1_q1 = 1.0 + k.c1 * d_p1_d_q1;
    const Real R_q1_q2 = k.c1 * d_p1_d_q2;
    const Real R_q2 = -(carry.q2 - q2_gap_1);
    const Real R_q2_q1 = k.c1 * d_p1_d_q2;
    const Real R_q2_q2 = 1.0 + k.c1 * d_p2_d_q2;
    const Real inverse_det_q1 = 1.0 / (R_q1_q1 * R_q2_q2 - R_q1_q2 * R_q2_q1);
    delta_q1 = -inverse_det_q1 * (R_q1 * R_q2_q2 - R_q1_q2 * R_q2);
    delta_q2 = inverse_det_q1 * (R_q1 * R_q2_q1 - R_q1_q1 * R_q2);
    const Real moved[2] = {magnitude(delta_q1), magnitude(delta_q2)};
    const Real length[2] = {magnitude(q1_bar) + magnitude(q1), magnitude(q2_bar) + magnitude(q2)};
    const Real way[2] = {magnitude(q1_bar - q1), magnitude(q2_bar - q2)};
    const Verdict verdict = start.rule_0.of_each(moved, length, way, 2, iteration);
    if (verdict == Verdict::failed) {
      report.iterations += iteration;
      report.increment = start.rule_0.previous;
      return report;
    }
    if (verdict == Verdict::done) {
      report.iterations += iteration;
      break;
    }
    q1_bar += delta_q1;
    q2_bar += delta_q2;
  }
  start.value[0] = q1_bar + delta_q1;
  start.value[1] = q2_bar + delta_q2;
  // The last increments correct the gradient to first order: no evaluation at the solution.
  const Real change_H_q1 = delta_q1 * H_q1_q1 + delta_q2 * H_q1_q2;
  const Real change_H_q2 = delta_q1 * H_q1_q2 + delta_q2 * H_q2_q2;
  const Real change_H_p1 = k.c1 * change_H_q1;
  const Real change_H_p2 = k.c1 * change_H_q2;
  dz.q1 = h * p1_bar;
  rest.q1 = carry.q1 + h * change_H_p1;
  dz.q2 = h * p2_bar;
  rest.q2 = carry.q2 + h * change_H_p2;
  dz.p1 = -h * H_q1;
  rest.p1 = carry.p1 - h * change_H_q1;
  dz.p2 = -h * H_q2;
  rest.p2 = carry.p2 - h * change_H_q2;
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
  const Coefficients k = prepare(par, h);
  Start start;
  State dz, rest;
  const StepReport report = solve(par, k, h, z, State(), start, dz, rest);
  if (!report.converged) return report;
  z.q1 += dz.q1 + rest.q1;
  z.q2 += dz.q2 + rest.q2;
  z.p1 += dz.p1 + rest.p1;
  z.p2 += dz.p2 + rest.p2;
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
    StepReport report = solve(par_, k_, h_, z_, carry_, start_, dz, rest);
    if (!report.converged && start_.known) {
      // Extrapolation may lead astray, the state itself seldom does.
      const long long wasted = report.iterations;
      start_ = Start();
      report = solve(par_, k_, h_, z_, carry_, start_, dz, rest);
      report.iterations += wasted;
    }
    if (!report.converged) return report;
    start_.rule_0.watch(history_, start_.value, 0, 2);
    history_.record(start_.value);
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
    start_ = Start();
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
  History<2> history_;
};

}  // namespace emitted_9623af6a
}  // namespace kepler::implicit_midpoint
#elif HAMGEN_METHOD_kepler_implicit_midpoint != 0x9623af6a
#error "another method of this name is included before: generate one with --namespace"
#endif

#ifdef __clang__
#pragma float_control(pop)
#endif
