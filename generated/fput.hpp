// fput, implicit-midpoint.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0, in C++17
//   command   hamgen generate hamiltonians/fput.ham
//   model     hamiltonians/fput.ham
//   sha256    224b46ae962ab84d43e2b44e3f7bf279671a7663e950b3ec00e1a0d830a404ca
//   H(q, p) = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^2/2 + alpha*(q[i+1] -
//             q[i])^3/3)
//   scheme    alpha = 1/2, beta = 0, gamma = 0: order 2, symmetric, symplectic
//   step      Q = q + h dH/dp, P = p - h dH/dq at qbar = (q + Q)/2, pbar = (p + P)/2
//   proved    symplectic, symmetric, order 2, emitted code
//   solve     fixed point, banded Newton of size 32 where it contracts slowly; momenta torn out,
//             in loops
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//             expansion of the sums: 32 degrees of freedom stay loops
//             Eigen: the matrix has bandwidth 1
//             32 of the unknowns: torn out
//             masses as an array: all are 1
//   cost      per iteration: 574 + - *; per step besides: 990 + - *
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

#ifndef HAMGEN_SYSTEM_fput
#define HAMGEN_SYSTEM_fput 0xf47ff3cd
namespace fput {
inline namespace emitted_f47ff3cd {

using Real = double;
inline constexpr int n = 32;  // degrees of freedom

struct Parameters {
  Real alpha = 0.25;  // strength of the quadratic force
};

struct State {
  Real q[32] = {};
  Real p[32] = {};
};

// H(q, p).
inline Real energy(const Parameters& par, const State& z) {
  Real sum = 0.0;
  for (int i = 1; i <= 32; ++i) {
    const Real p_i = z.p[i - 1];
    sum += 0.5 * (p_i * p_i);
  }
  for (int i = 1; i <= 31; ++i) {
    const Real q_i_plus_1 = z.q[i];
    const Real q_i = z.q[i - 1];
    const Real t1 = q_i_plus_1 - q_i;
    const Real t2 = t1 * t1;
    sum += 0.5 * t2 + (1.0 / 3.0) * par.alpha * t1 * t2;
  }
  {
    const Real q_1 = z.q[0];
    const Real t1 = q_1 * q_1;
    sum += 0.5 * t1 + (1.0 / 3.0) * par.alpha * q_1 * t1;
  }
  {
    const Real q_32 = z.q[31];
    const Real t1 = q_32 * q_32;
    sum += 0.5 * t1 - (1.0 / 3.0) * par.alpha * q_32 * t1;
  }
  return sum;
}

// dq[i] = dH/dq_i.
inline void potential_gradient(const Parameters& par, const Real* q, Real* dq) {
  dq[0] = 0.0;
  dq[31] = 0.0;
  for (int i = 2; i <= 31; ++i) {
    const Real q_i = q[i - 1];
    const Real q_i_minus_1 = q[i - 2];
    const Real q_i_plus_1 = q[i];
    const Real t1 = q_i_minus_1 - q_i;
    const Real t2 = q_i - q_i_plus_1;
    dq[i - 1] = -(q_i_minus_1 - q_i - par.alpha * (t1 * t1));
    dq[i - 1] += q_i - q_i_plus_1 - par.alpha * (t2 * t2);
  }
  {
    const Real q_2 = q[1];
    const Real q_1 = q[0];
    const Real t1 = q_1 - q_2;
    dq[0] += q_1 - q_2 - par.alpha * (t1 * t1);
  }
  {
    const Real q_32 = q[31];
    const Real q_31 = q[30];
    const Real t1 = q_31 - q_32;
    dq[31] += -(q_31 - q_32 - par.alpha * (t1 * t1));
  }
  {
    const Real q_1 = q[0];
    dq[0] += q_1 + par.alpha * (q_1 * q_1);
  }
  {
    const Real q_32 = q[31];
    dq[31] += q_32 - par.alpha * (q_32 * q_32);
  }
}

// dp[i] = dH/dp_i.
inline void kinetic_gradient(const Parameters&, const Real* p, Real* dp) {
  for (int i = 1; i <= 32; ++i) {
    const Real p_i = p[i - 1];
    dp[i - 1] = p_i;
  }
}

// dq[i] = dH/dq_i, dp[i] = dH/dp_i.
inline void gradient(const Parameters& par, const Real* q, const Real* p, Real* dq, Real* dp) {
  potential_gradient(par, q, dq);
  kinetic_gradient(par, p, dp);
}

// grad H, the derivatives by q first.
inline void gradient(const Parameters& par, const State& z, Real (&values)[2 * n]) {
  gradient(par, z.q, z.p, values, values + n);
}

}  // namespace emitted_f47ff3cd
}  // namespace fput
#elif HAMGEN_SYSTEM_fput != 0xf47ff3cd
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

#ifndef HAMGEN_9581D1FB_FLOAT64_SUMS
#define HAMGEN_9581D1FB_FLOAT64_SUMS
// A sum of many terms, in eight parts that do not wait for each other.
template <class Term>
inline Real sum_of(int count, const Term& term) {
  Real parts[8] = {};
  int j = 0;
  if constexpr (sizeof(Real) <= 8) {
    for (; j + 8 <= count; j += 8) {
#if defined __AVX__ && \
    !defined __clang__  // else g++ takes them apart, and adds one after the other
#pragma GCC unroll 1
#endif
      for (int k = 0; k < 8; ++k) parts[k] += term(j + k);
    }
  } else {
    for (; j + 8 <= count; j += 8) {
      for (int k = 0; k < 8; ++k) parts[k] += term(j + k);
    }
  }
  for (int k = 0; j + k < count; ++k) parts[k] += term(j + k);
  return ((parts[0] + parts[4]) + (parts[1] + parts[5])) +
         ((parts[2] + parts[6]) + (parts[3] + parts[7]));
}
// Of a known number of them: eight at once are not written where there are fewer, or g++ warns of
// elements beyond the last.
template <int Count, class Term>
inline Real sum_of(const Term& term) {
  if constexpr (Count >= 8) {
    return sum_of(Count, term);
  } else {
    Real parts[8] = {};
    for (int k = 0; k < Count; ++k) parts[k] = term(k);
    return ((parts[0] + parts[4]) + (parts[1] + parts[5])) +
           ((parts[2] + parts[6]) + (parts[3] + parts[7]));
  }
}
template <int Size>
inline Real lengths_of(const Real (&vector)[Size]) {
  return sum_of<Size>([&](int j) { return magnitude(vector[j]); });
}
template <int Size>
inline Real squares_of(const Real (&vector)[Size]) {
  return sum_of<Size>([&](int j) { return vector[j] * vector[j]; });
}
// Of their sum.
template <int Size>
inline Real squares_of(const Real (&vector)[Size], const Real (&other)[Size]) {
  return sum_of<Size>([&](int j) { return (vector[j] + other[j]) * (vector[j] + other[j]); });
}
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_BAND_MATRIX
#define HAMGEN_9581D1FB_FLOAT64_BAND_MATRIX
// A matrix whose entries lie within Width of the diagonal.  Elimination with partial pivoting fills
// as many diagonals again above it.  Row i holds columns i - Width on.
template <int Size, int Width>
class BandMatrix {
 public:
  static constexpr int size = Size;
  void clear() {
    for (auto& row : entry_) {
      for (Real& value : row) value = 0;
    }
  }
  void put(int row, int column, Real value) { at(row, column) += value; }
  // False if the matrix is singular or not finite.
  bool factorise() {
    for (int c = 0; c < size; ++c) {
      const int last_row = c + Width < size ? c + Width : size - 1;
      const int last_column = c + 2 * Width < size ? c + 2 * Width : size - 1;
      int pivot = c;
      for (int r = c + 1; r <= last_row; ++r) {
        if (magnitude(at(r, c)) > magnitude(at(pivot, c))) pivot = r;
      }
      if (!(magnitude(at(pivot, c)) > 0)) return false;
      pivot_[c] = pivot;
      if (pivot != c) {
        for (int j = c; j <= last_column; ++j) {
          const Real kept = at(c, j);
          at(c, j) = at(pivot, j);
          at(pivot, j) = kept;
        }
      }
      const Real reciprocal = 1 / at(c, c);
      for (int r = c + 1; r <= last_row; ++r) {
        const Real factor = at(r, c) * reciprocal;
        factor_[c][r - c - 1] = factor;
        for (int j = c + 1; j <= last_column; ++j) at(r, j) -= factor * at(c, j);
      }
    }
    return true;
  }
  void solve(Real (&x)[size]) const {
    for (int c = 0; c < size; ++c) {
      const Real kept = x[c];
      x[c] = x[pivot_[c]];
      if (pivot_[c] != c) x[pivot_[c]] = kept;
      const int last_row = c + Width < size ? c + Width : size - 1;
      for (int r = c + 1; r <= last_row; ++r) x[r] -= factor_[c][r - c - 1] * x[c];
    }
    for (int r = size - 1; r >= 0; --r) {
      const int last_column = r + 2 * Width < size ? r + 2 * Width : size - 1;
      for (int j = r + 1; j <= last_column; ++j) x[r] -= at(r, j) * x[j];
      x[r] /= at(r, r);
    }
  }

 protected:
  static constexpr int columns = 3 * Width + 1;
  Real& at(int row, int column) { return entry_[row][column - row + Width]; }
  const Real& at(int row, int column) const { return entry_[row][column - row + Width]; }
  Real entry_[size][columns] = {};
  Real factor_[size][Width] = {};
  int pivot_[size] = {};
};
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_SYMMETRIC_BAND_MATRIX
#define HAMGEN_9581D1FB_FLOAT64_SYMMETRIC_BAND_MATRIX
// A symmetric one: L D L^T without pivots where it is positive definite, else as any other one.
template <int Size, int Width>
class SymmetricBandMatrix : public BandMatrix<Size, Width> {
  using Band = BandMatrix<Size, Width>;
  using Band::entry_, Band::factor_;

 public:
  static constexpr int size = Size;
  // False if the matrix is singular or not finite.
  bool factorise() {
    is_definite_ = decompose();
    return is_definite_ || Band::factorise();
  }
  void solve(Real (&x)[size]) const {
    if (!is_definite_) return Band::solve(x);
    for (int r = 0; r < size && r < Width; ++r) x[r] = less_those_above(x, r, r);
    for (int r = Width; r < size; ++r) x[r] = less_those_above(x, r, Width);
    for (int r = 0; r < size; ++r) x[r] *= reciprocal_[r];
    int r = size - 1;
    for (; r >= 0 && r > size - 1 - Width; --r) x[r] = less_those_below(x, r, size - 1 - r);
    for (; r >= 0; --r) x[r] = less_those_below(x, r, Width);
  }

 private:
  // The nearest comes last: it is the one that is waited for.
  Real less_those_above(const Real (&x)[size], int r, int count) const {
    Real value = x[r];
    for (int k = count; k > 0; --k) value -= factor_[r - k][k - 1] * x[r - k];
    return value;
  }
  Real less_those_below(const Real (&x)[size], int r, int count) const {
    Real value = x[r];
    for (int k = count; k > 0; --k) value -= factor_[r][k - 1] * x[r + k];
    return value;
  }
  // False where the matrix is not positive definite.
  bool decompose() {
    for (int r = 0; r < size && r < Width; ++r) {
      if (!eliminate(r, r)) return false;
    }
    for (int r = Width; r < size; ++r) {
      if (!eliminate(r, Width)) return false;
    }
    return true;
  }
  bool eliminate(int r, int rows_above) {
    Real row[Width + 1];  // of D L^T: columns r to r + Width, those beyond the last are zero
    for (int j = 0; j <= Width; ++j) row[j] = entry_[r][Width + j];
    for (int k = rows_above; k > 0; --k) {
      const Real scaled = factor_[r - k][k - 1] * diagonal_[r - k];
      for (int j = 0; j + k <= Width; ++j) row[j] -= scaled * factor_[r - k][k - 1 + j];
    }
    if (!(row[0] > 0)) return false;
    diagonal_[r] = row[0];
    reciprocal_[r] = 1 / row[0];
    for (int j = 1; j <= Width; ++j) factor_[r][j - 1] = row[j] * reciprocal_[r];
    return true;
  }
  bool is_definite_ = false;
  Real diagonal_[size] = {};    // D
  Real reciprocal_[size] = {};  // of it
};
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

#ifndef HAMGEN_9581D1FB_FLOAT64_WAITING_NEWTON_RULE
#define HAMGEN_9581D1FB_FLOAT64_WAITING_NEWTON_RULE
// NewtonRuleOfMany of an iteration that many steps do without: these are not watched.
template <int Power, int Unknowns>
struct WaitingNewtonRule : NewtonRuleOfMany<Power, Unknowns> {
  using Watched = NewtonRuleOfMany<Power, Unknowns>;
  bool used = false;

  void begin(bool from_prediction) {
    Watched::begin(from_prediction);
    used = true;
  }
  template <class Past, class Solution>
  void watch(const Past& past, const Solution& solution, int first, int count) {
    if (used) {
      Watched::watch(past, solution, first, count);
    } else {
      this->motion = {};
    }
    used = false;
  }
};
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_FIXED_POINT_RULE
#define HAMGEN_9581D1FB_FLOAT64_FIXED_POINT_RULE
// How far an iteration has moved: sums over the unknowns of their increments, of what these are
// rounded with, and of the increments of those that are not near their end.
struct Distance {
  // Over so many units of rounding, and from there `amplifier` times as far, what is not linear is
  // far below them, and Refinement goes on: in double 2^17 * 2^28 * 2^-52 of a unit, and of what is
  // left after a contraction less than that. In float 16384 units are 2e-3 of a number; 4 give
  // 2^7 * 2^4 * 2^-23.
  Real units = epsilon < Real(1e-10) ? 16384 : 4;
  // In loops a round of Refinement costs more than an iteration: there it is left less.  Nor may
  // one of many unknowns, whose sum is near, be left some thousand units: between walls exp(40 (q -
  // 1)) the way that is looked over is not straight then, and its energy fell by 8e-4 roundings a
  // step.
  void narrow() {
    if (units > 64) units = 64;
  }
  // What is less than this of the whole, far below what rounding takes from it, is not waited for:
  // ahead of a wave every unknown is so much smaller than the one before it that an iteration
  // brings one after the other to its end.
  static constexpr Real lost = epsilon * epsilon * epsilon;
  // What is rounded like this: a unit of rounding of smaller numbers may be lost below the smallest
  // number there is, and how far they are from their end cannot be told by it.
  static constexpr Real tiny = 1 / largest;
  Real size = 0;
  Real scale = 0;
  Real far = 0;

  Real far_of(Real moved, Real length) const {
    return moved <= units * epsilon * (length + tiny) ? Real(0) : moved;
  }
  bool near() const { return far <= lost * scale; }
  Real round_off() const { return epsilon * (scale + 64 * tiny); }

  void add(Real moved, Real length) {
    size += moved;
    scale += length;
    far += far_of(moved, length);
  }
  // Arrays of them, rounded with what stands beside.
  void add(const Real* moved, const Real* value, const Real* beside, int count) {
    const Real all_moved = sum_of(count, [&](int j) { return magnitude(moved[j]); });
    const Real all_lengths =
        sum_of(count, [&](int j) { return magnitude(value[j]) + magnitude(beside[j]); });
    size += all_moved;
    scale += all_lengths;
    // Not each is near where all of them together are not.
    Real all_far = far_of(all_moved, 2 * all_lengths);
    if (all_far <= 0) {
      all_far = sum_of(count, [&](int j) {
        return far_of(magnitude(moved[j]), magnitude(value[j]) + magnitude(beside[j]));
      });
    }
    far += all_far;
  }
};
// When to stop an iteration that has no other end than rounding: where all unknowns are near it and
// the next increment is lost in it, or at stagnation, when twice in a row it has not moved less
// than ever before.  Every Cycle-th iteration is compared: 2 for a fixed point, where q hangs on p
// and p on q alone, so that even and odd iterations are two sequences, and one may be far ahead of
// the other; 1 for Newton's iteration. The larger the last increment, the longer it must stand
// still: 64, 512, 4096 units of rounding after 2, 3, 4 times.
//
// Note [what is lost in rounding]
// Refinement begins with what rounding leaves of the unknowns, and takes as many rounds for that as
// for some 8 units more.  So the next increment may be as large: it is the last one times the
// contraction, which this and the one before it show.  A first increment is judged by the
// contraction of the step before, four times over, but for every 32nd.  (With 64 units, pairs whose
// bond is a 1e6th of their coordinates were off by 51 roundings: over such a way, amplified, their
// force is not linear.)
//
// What grows a thousandfold after four increments, in which momenta and coordinates of different
// units may have found each other, does not come back: it began with a prediction that led astray,
// and would go on to numbers whose sines take ten times as long.
template <int Cycle>
struct FixedPointRule {
  Real least[Cycle] = {};  // 0 before the first increment
  Real size = 0;           // of the last increment
  Real before = 0;         // and of the one before it in this step, if there is one
  Real contraction = 1;    // of these two, in the step before
  int unchecked = 32;      // steps since it was measured
  int stuck = 0;
  Real begun = 0;  // the largest of the first four increments

  void begin() {
    begun = 0;
    for (Real& smallest : least) smallest = 0;
    stuck = 0;
    if (before > 0) {
      contraction = size < before ? size / before : Real(1);
      unchecked = 0;
    }
    size = 0;
  }
  Verdict operator()(const Distance& moved, int iterations) {
    const Verdict verdict = judge(moved, iterations);
    return verdict == Verdict::go_on && comes_near(moved) ? Verdict::done : verdict;
  }
  // Of an iteration that has been judged: see Note [what is lost in rounding].
  bool comes_near(const Distance& moved) {
    const Real most = 8 * moved.round_off();
    if (before > 0) return size * size <= most * before && size < before && moved.near();
    return ++unchecked <= 32 && 4 * contraction * size <= most && moved.near();
  }
  // By the last increment alone.
  Verdict judge(const Distance& moved, int iterations) {
    before = size;
    size = moved.size;
    if (!(size <= largest)) return Verdict::failed;
    if (iterations <= 4) {
      if (size > begun) begun = size;
    } else if (size > 1024 * begun) {
      return Verdict::failed;
    }
    const Real round_off = moved.round_off();
    if (moved.near() && size <= 64 * round_off) return Verdict::done;
    Real& smallest = least[iterations % Cycle];
    const bool decreased = smallest <= 0 || size < smallest;
    if (decreased) smallest = size;
    stuck = decreased ? 0 : stuck + 1;
    if (stuck >= 2 && size <= 64 * round_off) return Verdict::done;
    if (stuck >= 3 && size <= 512 * round_off) return Verdict::done;
    if (stuck >= 4 && size <= 4096 * round_off) return Verdict::done;
    // What still decreases then does so by a few hundredths at a time: much more is missing.
    return iterations < 500 ? Verdict::go_on : Verdict::failed;
  }
};
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_CONTRACTION_RULE
#define HAMGEN_9581D1FB_FLOAT64_CONTRACTION_RULE
// When to stop a fixed point that starts near its end: where what is still missing is lost in
// rounding, as far as the contraction is known; else FixedPointRule and Refinement have the word.
//
// Note [what an increment leaves]
// An increment of this size leaves the unknowns contraction * size from the solution, and the
// slopes taken there, which are all that a step keeps, another factor of the contraction.  That is
// a bias where rounding is a random walk, and in the momenta it counts 1/h times: the factor 2^-20
// keeps it below the sum of the rounding errors.  The slopes are then taken without Refinement.
//
// The contraction is that of two increments well above rounding, or what Refinement finds, at least
// in every 32nd step.  Whatever it was, what the equations lack where the slopes are taken is
// looked at in every step: if it is not lost in the rounding of the unknowns, Refinement goes on.
//
// Note [who has chosen the point]
// The image of the last iterate is near a point that the rounded map takes to itself, and which one
// that is its rounding has chosen, as far as it is seen through the contraction: 13 bodies lost
// 3e-4 roundings a step by a slow one, a linear ring of 30 2e-4 by one of 1/36, 9e-5 by 1/80, and
// nothing by 1/142.  Refinement begins at the iterate itself, down to 1/96, where what is
// seen, in proportion to the contraction, is below the 1e-4 that a step may be off in the mean.
//
// Note [what is far from its end]
// Of many unknowns most may hardly contract what one of them does at a wall, and what is told of
// all together is not true of that one.  Of 30 with two between walls exp(40 (q - 1)) these were
// thousands of units from their end and ended with the first increment: their energies were off by
// 6e-2 of a rounding more in every step.  Where each unknown was near before the last increment
// that is sure to be little.  Else Refinement looks at what follows the increment of each: what the
// equations lack behind it, less what rounding took from it, which is known without an error.  No
// more than a 2^-14th of the rounding of its momentum, of which its way is 1/h, may follow that in
// the same ratio.  (Asked of sums it was 8e-2 of a rounding beside others that are louder.)
//
// Note [of one or of two]
// Where coordinates move momenta and these the coordinates, two increments are in a ratio to each
// other that says how differently both are missing, and the next two are in another: both ratios
// together are the contraction of two (Cycle 2).  The next increment but one is that times the last
// one, in either case.
template <int Cycle>
struct ContractionRule {
  FixedPointRule<2> rule;
  Real contraction = largest;  // of so many increments; where nothing is known
  Real size = 0;               // of the last increment
  Real past[Cycle] = {};       // and of those before it, the oldest first; 0: there was none
  Real round_off = 0;
  Real of_round = 1;
  int work = 0;
  int unchecked = 0;
  bool near = false;  // is each unknown?
  bool sure = false;  // was each before the last increment?
  bool settled = false;

  // What the other solver's matrix costs, in evaluations of the equations; 0: there is no other.
  void begin(int matrix_work) {
    rule.begin();
    size = 0;
    for (Real& each : past) each = 0;
    work = matrix_work;
    near = false;
    settled = false;
  }
  Verdict operator()(const Distance& moved, int iterations) {
    for (int k = 1; k < Cycle; ++k) past[k - 1] = past[k];
    past[Cycle - 1] = size;
    const Real before = past[0];
    Verdict verdict = rule.judge(moved, iterations);
    size = rule.size;
    round_off = moved.round_off();
    sure = near || size <= 0;
    near = moved.near();
    if (verdict == Verdict::failed) return give_up();
    if (before > 0 && size > 64 * round_off) learn(size / before);
    if (is_slow()) return give_up();
    // Of an increment that is mostly rounding, what is missing from before.
    Real missing = size;
    if (before > 0 && size <= round_off && contraction * before < size) {
      missing = contraction * before;
    }
    settled = unchecked < 32 && is_lost(missing);
    if (settled) return Verdict::done;
    // So few increments say nothing of the contraction, and another may settle it; none at all,
    // as in a state of equilibrium, never will.
    const bool grows = before > 0 && of_two(2) * size > before && size > 8 * round_off;
    const bool goes_on = before > 0 ? grows && work > 0 : contraction >= largest || is_lost(next());
    const bool may_go_on = size > 0 && iterations < 500;
    return verdict == Verdict::done && goes_on && may_go_on ? Verdict::go_on : verdict;
  }
  // Is the last increment made?  See Note [who has chosen the point].
  bool moves() const { return settled || contraction * of_two(96) <= 1; }
  // It may rise at once but falls slowly: one small increment may be luck.
  void learn(Real seen) {
    const bool first = contraction >= largest;
    if (first || seen > contraction || of_two(4) * seen > contraction) {
      contraction = seen;
    } else {
      contraction /= of_two(4);
    }
    unchecked = 0;
  }
  // Of rounds of Refinement: what so many behind the first one left of it.  Of two that is seen as
  // far as a difference over so long a way tells; where it is less, it is what one did, twice.
  void learn_of_rounds(int count, Real left, Real visible) {
    if (count == 1) of_round = left;
    if (count != Cycle) return;
    if (Cycle == 1 || left > visible) return learn(left);
    const Real twice = of_round * of_round;
    learn(twice < visible ? twice : visible);
  }
  // Rounds that are asked for, where otherwise nothing would be known.
  int rounds_asked() const {
    return Cycle == 2 && (contraction >= largest || unchecked >= 32) ? 2 : 0;
  }
  // Would an iteration of Newton's, which costs as much as so many increments, come nearer by more
  // than these?  By a fourth of all digits, as two to three of them come from a prediction to the
  // solution.
  bool is_slow() const {
    if (work == 0 || contraction >= largest) return false;
    Real left = 1;
    for (int round = 0; round < work; ++round) left *= contraction;
    const Real of_digits = Cycle == 1 ? left * left : left;
    return 2 * contraction > 1 || of_digits * of_digits > epsilon;
  }
  // Where it is: when it is tried again, things may have changed.
  bool gives_up() {
    const bool slow = is_slow();
    if (slow) contraction = largest;
    return slow;
  }

 private:
  // What one increment does is done twice by two.
  static constexpr Real of_two(Real of_one) { return Cycle == 1 ? of_one : of_one * of_one; }
  bool is_lost(Real missing) const {
    const Real of_next_but_one = Cycle == 1 ? contraction * contraction : contraction;
    return contraction < 1 && of_next_but_one * missing * 1048576 <= round_off;
  }
  // The next increment; of two, if the one before it is not known, as if it fell by a 64th.
  Real next() const {
    if (Cycle == 1) return contraction * size;
    return past[Cycle - 1] > 0 ? contraction * past[Cycle - 1] : size / 64;
  }
  Verdict give_up() {
    if (work > 0) contraction = largest;
    return Verdict::failed;
  }
};
#endif

#ifndef HAMGEN_9581D1FB_FLOAT64_REFINEMENT
#define HAMGEN_9581D1FB_FLOAT64_REFINEMENT
// The end of a fixed-point iteration, below the last place of its unknowns.  Of the points that its
// rounded map takes to themselves it ends at one on the side it came from, and at one where the
// rounding of the map lets it: at every step alike, a bias and no chance.  So it goes on from any
// point close by, some ten units of rounding from the solution.  What the equations lack there is
// small, and known without an error.  Over that distance they are linear, and their change along it
// is found by a difference over one `amplifier` times as long: what is not linear, and what a
// difference loses, are both far below a unit of rounding.
//
// Note [what a round leaves]
// The last round's increment is seen by nobody: the slopes are those before it.  By it they, and
// the step, are off as much as the next round would move, the contraction times that, and what is
// cut off is a bias: a 2^-13th of a unit.  The contraction is that of two rounds, of this step or
// of the one before, in units of each unknown, four times over: beside others 1e6 times as large,
// by lengths, two at walls lost 4e-4 of a rounding a step.  No more than a 32nd of a unit is left.
// Where stages are those of coordinates alone it is a 1024th: momenta, which are no unknowns then,
// are moved by 1/h times as much.  With a 32nd gauss-4 gained 4e-4 roundings of its energy a step
// between walls exp(40 (q - 1)).  (In float it is a 32nd: a difference there knows no more.)
//
// Note [two forms of the equations]
// Stages of coordinates alone have another form in rounds than that by which they first lack
// something, with rounded coefficients of its own: at the same point it differs by units of its
// terms, of which there is left what the amplifier divides them by.  In double that is nothing; in
// float it is a 128th, the same way at every step: the energy of an oscillator at h omega = 130
// grew by 4e-2 units a step.  There the second form is looked at where the first one was, too.
//
// Note [what is left behind]
// What a rule leaves of an unknown in every step, a 2^-14th of the rounding of its way, adds up to
// less than its walk at random.  What follows an increment shows how it shrinks, but no nearer than
// some roundings of its way, and behind those a pendulum, which left a hundredth of itself beside
// what was louder and shrank to a 1e4th, lost 2e-3 roundings a step.  So it is asked what a round
// of refinement leaves of each error, in every 48th step at least.  Its way is the longest of late:
// where an unknown turns back its energy is what it was.  One whose way grows by a 32nd in a step,
// as ahead of a wave, has little of an energy yet, and an increment of a rounding or two has its
// sign by chance: these are not asked.
//
template <int Size, int Components, bool RoundsBeside = false, bool TwoForms = false>
struct Refinement {
  // A power of two near the third root of 1/epsilon.
  static constexpr Real find_amplifier() {
    Real power = 1;
    while (power * power * power * (8 * epsilon) < 1) power *= 2;
    return power;
  }
  static constexpr Real amplifier = find_amplifier();
  static constexpr Real tiny = 1 / largest;  // beside a unit that is nothing
  static constexpr Real fewest = TwoForms && amplifier > 4096 ? 1024 : 32;
  static constexpr int size = Size;
  static constexpr int components = Components;
  static constexpr bool rounds_beside = RoundsBeside;
  static constexpr bool looks_twice = TwoForms && amplifier < 4096;
  Real change[Components] = {};  // of the gradient, from the rounded point to the solution
  Real slope[Components] = {};   // the gradient at the rounded point
  Real at[Size] = {};            // that point
  Real missing[Size] = {};       // by the equations there
  Real moved[Size] = {};         // the solution less the point
  Real ways[Size] = {};          // of each, from where a step began
  Real longest[Size] = {};       // of these
  Real spans[Size] = {};         // lengths of each, the largest of late
  Real shrinks[Size] = {};       // what a round leaves of each error, in the mean of some
  Real beside = 0;               // a length that an unknown is rounded with, where it RoundsBeside
  Real behind = 0;               // what small unknowns lacked when the point moved on for them
  Real last = 0;                 // what the last round moved all together
  Real begun = 0;                // the first of these
  Real least = 0;                // of these
  Real parts = 0;                // what the last round moved each, in its units, all together
  Real contraction = 1;          // what a round moved of what the one before did
  int stuck = 0;                 // rounds that moved no less
  int rounds = 0;
  int asked = 0;    // rounds that a rule wants to see behind the first
  int untold = 48;  // steps since rounds have told how errors shrink
  bool changes = false;
  bool foreseen = false;  // the last increment, as it stands in moved, missing and at
  bool doubted = false;   // what a rule has settled, by what was seen
  bool looks = false;     // at what the other form lacks there
  bool asks = false;      // how errors shrink?
  Real lacked[looks_twice ? Size : 1] = {};
  Real sloped[looks_twice ? Components : 1] = {};  // the gradient with it
  bool found = true;  // was the solution at the end, or does the map not contract?

  // Before the last increment is made of a rule that is not sure: of each unknown what it is, what
  // rounding takes from it, and how far the unknown has come in the step, or in the one before:
  // where it turns back, two terms of its way cancel, and what they are rounded by is seen in
  // either.
  template <class Rule>
  void foresee(const Rule& rule, const Real* point, const Real* increment, const Real* from) {
    if (rule.sure || !rule.settled) return;
    for (int j = 0; j < Size; ++j) {
      const Real now = magnitude(point[j] - from[j]);
      const Real next = point[j] + increment[j];
      moved[j] = increment[j] - (next - point[j]);
      missing[j] = magnitude(increment[j]);
      at[j] = now > ways[j] ? now : ways[j];
      ways[j] = now;
    }
    foreseen = true;
  }
  // Where a rule has settled that nothing of it counts, and nothing is seen of it either, the
  // slopes are taken as they are; what else it finds of the contraction the rule gets to know.
  // Where that is_slow then the solution has not been found: it is left to the solver behind.
  // Unknowns that are small beside the others count for nothing in a rule's sums: as long as some
  // of them have not come to their end, or are too far from it for a difference, all go on.  What
  // was doubted then is so still, for nothing is seen of what is left behind that.
  template <class Rule>
  bool operator()(Rule& rule, Real* point, const Real* lack, const Real* gradient) {
    if (rounds == 0 && behind <= 0 && untold < 48) ++untold;
    if (rule.settled) {
      const Real little = epsilon * epsilon * rule.round_off;
      if (behind <= 0) doubted = !rule.sure && !is_believed(point, lack, little);
      foreseen = false;
      const bool seen = lacking(lack) > rule.round_off;
      const Real open = left(point, lack, seen ? 64 : 8);
      const bool waits = open > little;
      const bool ends = !seen && !waits && !doubted;
      const bool goes_ahead = waits && (behind <= 0 || 2 * open < behind);
      behind = goes_ahead ? open : 0;
      if (goes_ahead) {
        for (int j = 0; j < Size; ++j) point[j] += lack[j];
        return true;
      }
      if (ends) {
        ++rule.unchecked;
        found = true;
        take_slopes(gradient);
        if (changes) forget_changes();
        return false;
      }
      asks = true;
    }
    rule.settled = false;
    const int count = rounds;
    if (count == 0) asked = rule.rounds_asked();
    if (count == 1) tell_how_they_shrink(lack);
    const bool more = (*this)(point, lack, gradient);
    if (count > 0 && begun > 0) rule.learn_of_rounds(count, last / begun, 8 / amplifier);
    if (!more || !rule.is_slow()) return more;
    rounds = 0;
    for (int j = 0; j < Size; ++j) point[j] = at[j];
    return false;
  }
  // lack: the next value less the point, or that multiplied by a matrix that contracts better. True
  // if it wants these and the gradient once more, at the point it has moved; else that is the
  // rounded one again.
  bool operator()(Real* point, const Real* lack, const Real* gradient) {
    if (rounds == 0 && !looks) begin(point, lack, gradient);
    if constexpr (looks_twice) {
      if (rounds == 0) {
        looks = !looks;
        if (looks) return true;
        keep(lack, gradient);
      }
    }
    Real error[Size] = {};
    for (int j = 0; j < Size; ++j) {
      error[j] = error_of(j, lack);
      moved[j] += error[j];
    }
    // See Note [what a round leaves].
    const Real counts = times_counted();
    const Real open = sum_of<Size>([&](int j) {
      const Real unit = epsilon * length(at[j]) + magnitude(moved[j]) / 128;
      return magnitude(error[j]) * counts > unit ? magnitude(error[j]) : Real(0);
    });
    learn_of(lengths_of(error), sum_of<Size>([&](int j) {
               const Real unit = epsilon * length(at[j]) + magnitude(moved[j]) / 128;
               return magnitude(error[j]) / (unit + tiny);
             }));
    for (int k = 0; k < Components; ++k) change[k] = off(k, gradient) / amplifier;
    changes = true;
    const bool more = goes_on(open, lack);
    for (int j = 0; j < Size; ++j) point[j] = more ? at[j] + amplifier * moved[j] : at[j];
    return more;
  }

  // Begins anew.
  void forget() {
    rounds = 0;
    contraction = 1;
    untold = 48;
    for (int j = 0; j < Size; ++j) ways[j] = longest[j] = spans[j] = shrinks[j] = 0;
  }
  bool is_believed(const Real* point, const Real* lack, Real little) {
    return foreseen && not_lost_behind(point, lack) <= little && knows_how_they_shrink();
  }
  // Of the increments, where what is left behind counts: what follows is seen from some roundings
  // of a way on, which are those of the equations, and that again in the same ratio is left; or as
  // much as errors shrink.  See Note [what is left behind].
  Real not_lost_behind(const Real* point, const Real* lack) {
    for (int j = 0; j < Size; ++j) {
      const Real follows = magnitude(lack[j] - moved[j]);
      const Real before = longest[j] * (Real(1023) / 1024);
      longest[j] = ways[j] > before ? ways[j] : before;
      const bool grows = 32 * (longest[j] - before) > longest[j];
      const bool by_chance = missing[j] <= 2 * epsilon * length(point[j]);
      const Real seen = follows > 4 * epsilon * at[j] ? follows * (follows / missing[j]) : Real(0);
      const Real told = grows || by_chance ? Real(0) : shrinks[j] * shrinks[j] * missing[j];
      const Real left = seen > told ? seen : told;
      const Real larger = follows > missing[j] ? follows : missing[j];
      moved[j] = 16384 * left > epsilon * longest[j] ? larger : Real(0);
    }
    return lengths_of(moved);
  }
  // A single one is told by the rule itself.
  bool knows_how_they_shrink() const { return Size == 1 || untold < 48; }
  void tell_how_they_shrink(const Real* lack) {
    if (untold >= (asks ? 4 : 16)) learn_how_they_shrink(lack);
    asks = false;
  }
  // By the first round behind the rounded point, of the errors that this leaves: a rough pattern,
  // which shrinks less than a smooth one.
  void learn_how_they_shrink(const Real* lack) {
    for (int j = 0; j < Size; ++j) {
      const Real now = length(at[j]);
      const Real before = spans[j] * (Real(255) / 256);
      spans[j] = now > before ? now : before;
      const Real unit = epsilon * spans[j] / 4;
      const Real lacks = magnitude(missing[j]);
      const Real seen = magnitude(error_of(j, lack)) / ((lacks > unit ? lacks : unit) + tiny);
      const Real left = seen < 1 ? seen : Real(1);
      shrinks[j] = shrinks[j] > 0 ? (3 * shrinks[j] + left) / 4 : left;
    }
    untold = 0;
  }
  void forget_changes() {
    changes = false;
    for (Real& value : change) value = 0;
  }
  Real times_counted() const {
    const Real left = 32768 * contraction;
    return left > fewest ? (left < 8192 ? left : Real(8192)) : fewest;
  }
  void learn_of(Real length, Real units) {
    if (rounds > 0) contraction = units < parts ? units / parts : Real(1);
    parts = units;
    last = length;
  }
  void begin(const Real* point, const Real* lack, const Real* gradient) {
    for (int j = 0; j < Size; ++j) {
      at[j] = point[j];
      missing[j] = lack[j];
      moved[j] = 0;
    }
    take_slopes(gradient);
  }
  // See Note [two forms of the equations].
  void keep(const Real* lack, const Real* gradient) {
    for (int j = 0; j < Size; ++j) lacked[j] = lack[j];
    for (int k = 0; k < Components; ++k) sloped[k] = gradient[k];
  }
  // What the equations lack where the solution is taken to be.
  Real error_of(int j, const Real* lack) const {
    if constexpr (looks_twice) return missing[j] + (lack[j] - lacked[j]) / amplifier;
    return missing[j] + (lack[j] - missing[j]) / amplifier;
  }
  // How far the gradient is from that at the rounded point.
  Real off(int k, const Real* gradient) const {
    if constexpr (looks_twice) return gradient[k] - sloped[k];
    return gradient[k] - slope[k];
  }
  void take_slopes(const Real* gradient) {
    for (int k = 0; k < Components; ++k) slope[k] = gradient[k];
  }
  // Of which an unknown's rounding is a part.
  Real length(Real x) const {
    if constexpr (RoundsBeside) return magnitude(x) + beside;
    return magnitude(x);
  }
  // Of unknowns that lack more than so many units of their own rounding.
  Real left(const Real* point, const Real* lack, Real units) const {
    return sum_of<Size>([&](int j) {
      const Real lacks = magnitude(lack[j]);
      return lacks > units * epsilon * length(point[j]) ? lacks : Real(0);
    });
  }
  static Real lacking(const Real* lack) {
    return sum_of<Size>([&](int j) { return magnitude(lack[j]); });
  }
  // A slow contraction takes its time; what the rounding of the map leaves does not decrease.  What
  // is lost beside the first round is not waited for (Distance).
  bool goes_on(Real open, const Real* lack) {
    if (rounds == 0) begun = last;
    stuck = rounds == 0 || last < least ? 0 : stuck + 1;
    if (stuck == 0) least = last;
    const bool waits = open > epsilon * epsilon * begun;
    const bool more = (waits || rounds < asked) && stuck < 4 && rounds < 500;
    rounds = more ? rounds + 1 : 0;
    found = !waits || more || far_off(lack) <= 0;
    return more;
  }
  // Of unknowns that a round still moves by more than a 32nd of a unit, when no more is to be had,
  // and by a part of what the first one did that rounding does not leave.  A row of some eight
  // terms, each of the size of the largest unknown, is rounded by as many of its units, and a
  // difference over the amplifier by that part of them.  In double that is below a 2^-14th of a
  // unit, and the part of the first round answers for it; in float it is a 16th: an unknown that is
  // near zero for a moment could not be told from what does not converge, and steps that were
  // solved failed.
  Real far_off(const Real* lack) const {
    Real noise = 0;
    for (int j = 0; j < Size && amplifier < 4096; ++j) {
      const Real left = 8 * epsilon * magnitude(at[j]) / amplifier;
      noise = left > noise ? left : noise;
    }
    return sum_of<Size>([&](int j) {
      const Real error = magnitude(error_of(j, lack));
      const Real unit = epsilon * length(at[j]);
      const bool moves = error * 32 > unit && error * 1024 > begun;
      return moves && error > noise ? error : Real(0);
    });
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

#ifndef HAMGEN_METHOD_fput_implicit_midpoint
#define HAMGEN_METHOD_fput_implicit_midpoint 0xbb9d0c9d
namespace fput::implicit_midpoint {
inline namespace emitted_bb9d0c9d {

namespace numerics = ::hamgen_9581d1fb::float64;
using numerics::StepReport, numerics::magnitude, numerics::two_sum_with_rest, numerics::squares_of,
    numerics::SymmetricBandMatrix, numerics::Verdict, numerics::WaitingNewtonRule,
    numerics::Distance, numerics::ContractionRule, numerics::Refinement, numerics::History,
    numerics::forget;

using Matrix = SymmetricBandMatrix<32, 1>;

// What depends on h and the parameters alone.
struct Coefficients {
  Real half_h = 0.0;     // h/2
  Real h_high = 0.0;     // most of h, and no simple fraction
  Real h_low = 0.0;      // what is left
  Real half_high = 0.0;  // their halves
  Real half_low = 0.0;
  Real scale = 0.0;      // the matrix is I + scale V''
};

inline Coefficients prepare(const Parameters&, Real h) {
  Coefficients k;
  k.half_h = 0.5 * h;
  k.h_high = 0.9999 * h;
  k.h_low = h - k.h_high;
  k.half_high = 0.5 * k.h_high;
  k.half_low = 0.5 * k.h_low;
  k.scale = 0.25 * (h * h);
  return k;
}

// Start values of the implicit equations and what is remembered of their solution.
struct Start {
  Real value[32] = {};   // the coordinates of zbar
  bool known = false;    // else the state itself is the start
  Real slope[64] = {};   // grad H(zbar), dH/dq first
  Real lack[32] = {};    // of the equations, then the increment
  Real change[32] = {};  // of the slope by the last increment
  Matrix matrix;
  WaitingNewtonRule<2, 32> newton_rule;
  int patience = 0;      // steps left to Newton
  ContractionRule<1> rule;
  Refinement<32, 64> refinement;
};

// grad H at the stage, whose momenta follow from its coordinates, and what the equations
// lack there.
inline void evaluate(const Parameters& par, const Coefficients& k, const State& z,
                     const State& carry, Start& __restrict start) {
  potential_gradient(par, start.value, start.slope);
  for (int i = 0; i < n; ++i) {
    const Real p_push = k.half_h * start.slope[i];
    const Real change = carry.p[i] - p_push;
    const Real p_i = z.p[i] + change;
    start.slope[n + i] = p_i;
    const Real q_push = k.half_h * p_i;
    start.lack[i] = z.q[i] - start.value[i] + q_push + carry.q[i];
  }
}

// The same with h in two parts, of which neither is a simple fraction, for Newton's iteration.
inline void evaluate_in_parts(const Parameters& par, const Coefficients& k, const State& z,
                              const State& carry, Start& __restrict start) {
  potential_gradient(par, start.value, start.slope);
  for (int i = 0; i < n; ++i) {
    const Real p_push = k.half_h * start.slope[i];
    const Real change = carry.p[i] - p_push;
    const Real p_i = z.p[i] + change;
    start.slope[n + i] = p_i;
    const Real q_push = k.half_high * p_i;
    const Real q_small = carry.q[i] + k.half_low * p_i;
    start.lack[i] = z.q[i] - start.value[i] + q_push + q_small;
  }
}

// The derivative of the equations' residual, q first, at a stage.
inline void differentiate(const Parameters& par, const Coefficients& k, const Real* at,
                          Matrix& __restrict matrix) {
  matrix.clear();
  for (int i = 0; i < n; ++i) matrix.put(i, i, 1.0);
  for (int i = 1; i <= 31; ++i) {
    const Real q_i_plus_1 = at[i];
    const Real q_i = at[i - 1];
    const Real t1 = 1.0 + 2.0 * par.alpha * (q_i_plus_1 - q_i);
    matrix.put(i, i, k.scale * t1);
    matrix.put(i, i - 1, -k.scale * t1);
    matrix.put(i - 1, i, -k.scale * t1);
    matrix.put(i - 1, i - 1, k.scale * t1);
  }
  {
    const Real q_1 = at[0];
    const Real entry_1 = 1.0 + 2.0 * par.alpha * q_1;
    matrix.put(0, 0, k.scale * entry_1);
  }
  {
    const Real q_32 = at[31];
    const Real entry_1 = 1.0 - 2.0 * par.alpha * q_32;
    matrix.put(31, 31, k.scale * entry_1);
  }
}

// y = V'' u at a stage.
inline void potential_curvature(const Parameters& par, const Real* q, const Real* u, Real* y) {
  for (int i = 0; i < n; ++i) y[i] = 0.0;
  for (int i = 1; i <= 31; ++i) {
    const Real q_i_plus_1 = q[i];
    const Real q_i = q[i - 1];
    const Real t1 = 1.0 + 2.0 * par.alpha * (q_i_plus_1 - q_i);
    y[i] += t1 * u[i];
    y[i] += -t1 * u[i - 1];
    y[i - 1] -= t1 * u[i];
    y[i - 1] += t1 * u[i - 1];
  }
  {
    const Real q_1 = q[0];
    const Real entry_1 = 1.0 + 2.0 * par.alpha * q_1;
    y[0] += u[0] * entry_1;
  }
  {
    const Real q_32 = q[31];
    const Real entry_1 = 1.0 - 2.0 * par.alpha * q_32;
    y[31] += u[31] * entry_1;
  }
}

// False if the fixed point contracts so slowly that Newton's matrix is worth its work.
inline bool contract(const Parameters& par, const Coefficients& k, Real h, const State& z,
                     const State& carry, Start& __restrict start, State& __restrict dz,
                     State& __restrict rest, StepReport& __restrict report) {
  // Fixed-point iteration.
  start.rule.begin(3);
  for (int iteration = 1;; ++iteration) {
    evaluate(par, k, z, carry, start);
    Distance distance;
    distance.narrow();
    distance.add(start.lack, start.value, z.q, n);
    const Verdict verdict = start.rule(distance, iteration);
    if (verdict == Verdict::go_on || start.rule.moves()) {
      start.refinement.foresee(start.rule, start.value, start.lack, z.q);
      for (int i = 0; i < n; ++i) {
        start.value[i] += start.lack[i];
      }
    }
    if (verdict == Verdict::go_on) continue;
    report.iterations += iteration;
    if (verdict == Verdict::done) break;
    report.increment = start.rule.size;
    return false;
  }
  // What the equations lack at the rounded unknowns is solved for, too.
  if (start.rule.moves()) {
    evaluate(par, k, z, carry, start);
  }
  for (bool more = true; more;) {
    more = start.refinement(start.rule, start.value, start.lack, start.slope);
    if (more) {
      evaluate(par, k, z, carry, start);
    }
  }
  if (start.rule.gives_up()) return false;
  if (!start.refinement.found) {
    report.increment = start.refinement.last;
    return false;
  }
  for (int i = 0; i < n; ++i) {
    const Real p_push = k.half_h * start.refinement.slope[i];
    const Real moved = carry.p[i] - p_push;
    const Real bar = z.p[i] + moved;
    dz.q[i] = h * start.refinement.slope[n + i];
    rest.q[i] = carry.q[i] + h * start.refinement.change[n + i] + h * (z.p[i] - bar + moved);
    dz.p[i] = -h * start.refinement.slope[i];
    rest.p[i] = carry.p[i] - h * start.refinement.change[i];
  }
  // False for infinities and NaN alike.
  const Real length = squares_of(dz.q, rest.q) + squares_of(dz.p, rest.p);
  return length <= 1.0e308;
}

inline bool newton(const Parameters& par, const Coefficients& k, Real h, const State& z,
                   const State& carry, Start& __restrict start, State& __restrict dz,
                   State& __restrict rest, StepReport& __restrict report) {
  // Newton's iteration on what the equations lack.
  start.newton_rule.begin(start.known);
  for (int iteration = 1;; ++iteration) {
    evaluate_in_parts(par, k, z, carry, start);
    differentiate(par, k, start.value, start.matrix);
    if (!start.matrix.factorise()) {
      report.iterations += iteration;
      report.increment = Real(__builtin_inf());
      return false;
    }
    start.matrix.solve(start.lack);
    start.newton_rule.know(start.value, start.lack, 32);
    Real size = 0;
    Real uneven = 0;
    Real moved = 0;
    Real scale = 0;
    for (int i = 0; i < n; ++i) {
      size += magnitude(start.lack[i]) * start.newton_rule.unit[i];
      moved += magnitude(start.lack[i]);
      scale += magnitude(start.value[i]) + magnitude(z.q[i]);
      uneven += start.newton_rule.relative(i, magnitude(start.lack[i]), magnitude(start.value[i]) +
                                           magnitude(z.q[i]), magnitude(start.value[i] - z.q[i]));
    }
    const Verdict verdict = start.newton_rule.of_sums(start.value, start.lack, size, uneven, moved,
                                                      scale, 32, iteration);
    if (verdict == Verdict::failed) {
      report.iterations += iteration;
      report.increment = start.newton_rule.previous;
      return false;
    }
    if (verdict == Verdict::done) {
      report.iterations += iteration;
      break;
    }
    for (int i = 0; i < n; ++i) {
      start.value[i] += start.lack[i];
    }
  }
  potential_curvature(par, start.value, start.lack, start.change);
  for (int i = 0; i < n; ++i) start.value[i] += start.lack[i];
  for (int i = 0; i < n; ++i) {
    const Real q_small = carry.q[i] + k.h_low * start.slope[n + i];
    dz.q[i] = k.h_high * start.slope[n + i];
    rest.q[i] = q_small - h * k.half_h * start.change[i];
    dz.p[i] = -h * start.slope[i];
    rest.p[i] = carry.p[i] - h * start.change[i];
  }
  // False for infinities and NaN alike.
  const Real length = squares_of(dz.q, rest.q) + squares_of(dz.p, rest.p);
  return length <= 1.0e308;
}

// dz + rest = Z - z for one step from z + carry; rest is small.
[[nodiscard]] inline StepReport solve(const Parameters& par, const Coefficients& k, Real h,
                                      const State& z, const State& carry, Start& __restrict start,
                                      State& __restrict dz, State& __restrict rest) {
  StepReport report;
  if (!start.known) {
    for (int i = 0; i < n; ++i) start.value[i] = z.q[i];
  }
  // Newton where the fixed point contracts slowly, from the state too, and then for 32 steps.
  if (start.patience == 0) {
    start.patience = 32;
    for (int attempt = 0; attempt < 2; ++attempt) {
      if (contract(par, k, h, z, carry, start, dz, rest, report)) {
        start.patience = 0;
        break;
      }
      for (int i = 0; i < n; ++i) start.value[i] = z.q[i];
      start.known = false;
    }
  }
  if (start.patience > 0) {
    --start.patience;
    if (!newton(par, k, h, z, carry, start, dz, rest, report)) return report;
  }
  report.converged = true;
  return report;
}

// Many steps: start values are extrapolated, rounding errors of the updates carried along.
class Propagator {
 public:
  Propagator(const Parameters& par, Real h, const State& z)
      : par_(par), h_(h), z_(z), k_(prepare(par, h)) {}

  // One step; on failure the state stays as it was.
  StepReport step() {
    start_.known = history_.known > 0;
    if (start_.known) history_.extrapolate(start_.value);
    StepReport report = solve(par_, k_, h_, z_, carry_, start_, dz_, rest_);
    if (!report.converged && start_.known) {
      // Extrapolation may lead astray, the state itself seldom does.
      const long long wasted = report.iterations;
      start_.known = false;
      start_.newton_rule = {};
      report = solve(par_, k_, h_, z_, carry_, start_, dz_, rest_);
      report.iterations += wasted;
    }
    if (!report.converged) return report;
    start_.newton_rule.watch(history_, start_.value, 0, 32);
    history_.record(start_.value);
    for (int i = 0; i < n; ++i) {
      two_sum_with_rest(z_.q[i], carry_.q[i], dz_.q[i], rest_.q[i]);
      two_sum_with_rest(z_.p[i], carry_.p[i], dz_.p[i], rest_.p[i]);
    }
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
    start_.known = false;
    start_.newton_rule = {};
    start_.patience = 0;
    start_.rule = {};
    start_.refinement.forget();
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
  History<32> history_;
  State dz_, rest_;
};

// Advances z by one step of size h.  On failure z is left unchanged.
[[nodiscard]] inline StepReport step(const Parameters& par, Real h, State& z) {
  Propagator propagator(par, h, z);
  const StepReport report = propagator.step();
  if (report.converged) z = propagator.state();
  return report;
}

}  // namespace emitted_bb9d0c9d
}  // namespace fput::implicit_midpoint
#elif HAMGEN_METHOD_fput_implicit_midpoint != 0xbb9d0c9d
#error "another method of this name is included before: generate one with --namespace"
#endif

#ifdef __clang__
#pragma float_control(pop)
#endif
