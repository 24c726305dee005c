// fput, implicit-midpoint.  Generated: change the model, not this file.
//
//   made by   hamgen 0.1.0
//   command   hamgen generate hamiltonians/fput.ham
//   model     hamiltonians/fput.ham
//   sha256    224b46ae962ab84d43e2b44e3f7bf279671a7663e950b3ec00e1a0d830a404ca
//   H(q, p) = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^2/2 + alpha*(q[i+1] -
//             q[i])^3/3)
//   scheme    alpha = 1/2, beta = 0, gamma = 0: order 2, symmetric, symplectic
//   proved    symplectic, symmetric, order 2
//   tested    emitted code
//   solve     banded Newton of size 32; momenta torn out, in loops
//   left out  beta terms: beta = 0
//             gamma terms: gamma = 0
//             expansion of the sums: 32 degrees of freedom stay loops
//             Eigen: the matrix has bandwidth 1
//             32 of the unknowns: torn out
#pragma once
#include <cmath>

namespace fput::implicit_midpoint {

using Real = double;
inline constexpr int n = 32;  // degrees of freedom

struct Parameters {
  Real alpha = 0.25;  // strength of the quadratic force
};

struct State {
  Real q[32] = {};
  Real p[32] = {};
};

// On failure the increment says how far the iteration was from its end; it is not finite
// where the step left the domain of H.
struct StepReport {
  bool converged = false;
  int iterations = 0;
  Real increment = 0.0;
};

inline Real magnitude(Real x) { return std::fabs(x); }

// value += increment, with what rounding loses kept in carry (two-sum of Knuth).
inline void add(Real& value, Real& carry, Real increment) {
  const Real wanted = increment + carry;
  const Real sum = value + wanted;
  const Real part = sum - value;
  carry = (value - (sum - part)) + (wanted - part);
  value = sum;
}

enum class Verdict { go_on, done, failed };

// When to stop Newton's iteration: at round-off.  Increments shrink as
//   next <= contraction * size^2,
// where the contraction is measured, kept from step to step and checked at least every 32nd step.
// The last increment still enters the solution, so an iteration may stop when the next one would
// be lost in rounding.  What is cut off is a bias where rounding is a random walk, and in the
// momenta it counts 1/h times: the factor 2^-20 keeps it below the sum of the rounding errors.
struct NewtonRule {
  Real contraction = 1.0e308;
  int unchecked = 0;
  Real previous = 0;
  int grown = 0;

  void begin() {
    previous = 0;
    grown = 0;
  }
  Verdict operator()(Real size, Real scale, int iterations) {
    if (!(size <= 1.0e308)) return Verdict::failed;
    const Real round_off = 0x1p-52 * scale;
    if (previous > 0) {
      const Real seen = (size < round_off ? round_off : size) / (previous * previous);
      // It may rise at once but falls slowly: one small increment may be luck.
      const bool first = contraction >= 1.0e308;
      if (first || (size > 64 * round_off && seen > contraction)) {
        contraction = seen;
      } else if (seen < contraction) {
        contraction = 4 * seen < contraction ? contraction / 4 : seen;
      }
      unchecked = 0;
      // No progress twice in a row: this is round-off if it is small, else it may still recover.
      grown = size < previous ? 0 : grown + 1;
      if (grown >= 2 && size <= 4096 * round_off) return Verdict::done;
    } else {
      ++unchecked;
    }
    if (size <= round_off) return Verdict::done;
    if (unchecked < 32 && contraction * size * size * 1048576 <= round_off) return Verdict::done;
    previous = size;
    return iterations < 60 ? Verdict::go_on : Verdict::failed;
  }
};

// Solutions of earlier steps, extrapolated by polynomials.  With s_d the prediction of degree d
// and x the solution that came, the next predictions are
//   (d + 1) x - s_0 - ... - s_(d-1).
// The degree is chosen anew every 16th step: the one that predicted best that time.  As long as
// that is one of the highest known, the next one is tried.
struct History {
  static constexpr int unknowns = 32;
  static constexpr int degrees = 16;
  Real predicted[degrees][unknowns] = {};
  Real sum[unknowns] = {};
  int known = 0;  // degrees that are kept up to date
  int best = 0;
  int age = 15;

  void record(const Real (&solution)[unknowns]) {
    if (++age == 16) choose(solution);
    for (int i = 0; i < unknowns; ++i) sum[i] = 0;
    for (int degree = 0; degree < known; ++degree) {
      for (int i = 0; i < unknowns; ++i) {
        const Real kept = predicted[degree][i];
        predicted[degree][i] = Real(degree + 1) * solution[i] - sum[i];
        sum[i] += kept;
      }
    }
  }
  void choose(const Real (&solution)[unknowns]) {
    age = 0;
    Real least = 0;
    for (int degree = 0; degree < known; ++degree) {
      Real error = 0;
      for (int i = 0; i < unknowns; ++i) {
        error += magnitude(solution[i] - predicted[degree][i]);
      }
      if (degree == 0 || error < least) {
        least = error;
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
  void extrapolate(Real (&solution)[unknowns]) const {
    for (int i = 0; i < unknowns; ++i) solution[i] = predicted[best][i];
  }
};

// H(q, p).
inline Real energy([[maybe_unused]] const Parameters& par, const State& z) {
  const Real* x = z.q;  // p follows q
  Real sum = 0;
  for (int i = 1; i <= 32; ++i) {
    const Real p_i = x[i + 31];
    sum += 0.5 * (p_i * p_i);
  }
  {
    const Real q_1 = x[0];
    sum += 0.5 * (q_1 * q_1);
  }
  {
    const Real q_32 = x[31];
    sum += 0.5 * (q_32 * q_32);
  }
  for (int i = 1; i <= 31; ++i) {
    const Real q_i_plus_1 = x[i];
    const Real q_i = x[i - 1];
    const Real t1 = q_i_plus_1 - q_i;
    sum += 0.5 * (t1 * t1);
  }
  {
    const Real q_1 = x[0];
    const Real t1 = q_1 * q_1;
    sum += (1.0 / 3.0) * par.alpha * q_1 * t1;
  }
  {
    const Real q_32 = x[31];
    const Real t1 = q_32 * q_32;
    sum += -(1.0 / 3.0) * par.alpha * q_32 * t1;
  }
  for (int i = 1; i <= 31; ++i) {
    const Real q_i_plus_1 = x[i];
    const Real q_i = x[i - 1];
    const Real t1 = q_i_plus_1 - q_i;
    const Real t2 = t1 * t1;
    sum += (1.0 / 3.0) * par.alpha * t1 * t2;
  }
  return sum;
}

// Adds dH/dq to gradient[0..n-1].
inline void potential_gradient([[maybe_unused]] const Parameters& par,
                               [[maybe_unused]] const Real* x, [[maybe_unused]] Real* gradient) {
  {
    const Real q_1 = x[0];
    gradient[0] += q_1;
  }
  {
    const Real q_32 = x[31];
    gradient[31] += q_32;
  }
  for (int i = 1; i <= 31; ++i) {
    const Real q_i_plus_1 = x[i];
    const Real q_i = x[i - 1];
    const Real t1 = q_i_plus_1 - q_i;
    gradient[i] += t1;
    gradient[i - 1] += -t1;
  }
  {
    const Real q_1 = x[0];
    gradient[0] += par.alpha * (q_1 * q_1);
  }
  {
    const Real q_32 = x[31];
    gradient[31] += -par.alpha * (q_32 * q_32);
  }
  for (int i = 1; i <= 31; ++i) {
    const Real q_i_plus_1 = x[i];
    const Real q_i = x[i - 1];
    const Real t1 = q_i_plus_1 - q_i;
    const Real t2 = t1 * t1;
    gradient[i] += par.alpha * t2;
    gradient[i - 1] += -par.alpha * t2;
  }
}

// Adds dH/dp to gradient[n..2n-1].
inline void kinetic_gradient([[maybe_unused]] const Parameters& par, [[maybe_unused]] const Real* x,
                             [[maybe_unused]] Real* gradient) {
  for (int i = 1; i <= 32; ++i) {
    const Real p_i = x[i + 31];
    gradient[i + 31] += p_i;
  }
}

// grad H: the derivatives by q first.
inline void gradient(const Parameters& par, const Real* x, Real* values) {
  for (int i = 0; i < 2 * n; ++i) values[i] = 0;
  potential_gradient(par, x, values);
  kinetic_gradient(par, x, values);
}

// A matrix whose entries lie within 1 of the diagonal: elimination with partial
// pivoting, which fills as many diagonals again above it.  Row i holds columns i - width on.
class BandMatrix {
 public:
  void clear() {
    for (auto& row : entry_) {
      for (Real& value : row) value = 0;
    }
  }
  void put(int row, int column, Real value) { entry_[row][column - row + width] += value; }
  // False if the matrix is singular or not finite.
  bool factorise() {
    for (int c = 0; c < n; ++c) {
      const int last_row = c + width < n ? c + width : n - 1;
      const int last_column = c + 2 * width < n ? c + 2 * width : n - 1;
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
  void solve(Real (&vector)[n]) const {
    for (int c = 0; c < n; ++c) {
      const Real kept = vector[c];
      vector[c] = vector[pivot_[c]];
      if (pivot_[c] != c) vector[pivot_[c]] = kept;
      const int last_row = c + width < n ? c + width : n - 1;
      for (int r = c + 1; r <= last_row; ++r) vector[r] -= factor_[c][r - c - 1] * vector[c];
    }
    for (int r = n - 1; r >= 0; --r) {
      const int last_column = r + 2 * width < n ? r + 2 * width : n - 1;
      for (int j = r + 1; j <= last_column; ++j) vector[r] -= at(r, j) * vector[j];
      vector[r] /= at(r, r);
    }
  }

 private:
  static constexpr int width = 1;
  static constexpr int columns = 3 * width + 1;
  Real& at(int row, int column) { return entry_[row][column - row + width]; }
  const Real& at(int row, int column) const { return entry_[row][column - row + width]; }
  Real entry_[n][columns] = {};
  Real factor_[n][width > 0 ? width : 1] = {};
  int pivot_[n] = {};
};

// put(row, column, value) for the second derivatives of H, repeated entries to be added.
template <class Put>
inline void hessian([[maybe_unused]] const Parameters& par, [[maybe_unused]] const Real* x,
                    Put put) {
  {
    put(0, 0, 1.0);
  }
  {
    put(31, 31, 1.0);
  }
  for (int i = 1; i <= 31; ++i) {
    put(i, i, 1.0);
    const Real entry_2 = -1.0;
    put(i, i - 1, entry_2);
    put(i - 1, i, entry_2);
    put(i - 1, i - 1, 1.0);
  }
  {
    const Real q_1 = x[0];
    put(0, 0, 2.0 * par.alpha * q_1);
  }
  {
    const Real q_32 = x[31];
    put(31, 31, -2.0 * par.alpha * q_32);
  }
  for (int i = 1; i <= 31; ++i) {
    const Real q_i_plus_1 = x[i];
    const Real q_i = x[i - 1];
    const Real t1 = q_i_plus_1 - q_i;
    const Real t2 = 2.0 * par.alpha * t1;
    put(i, i, t2);
    const Real entry_2 = -2.0 * par.alpha * t1;
    put(i, i - 1, entry_2);
    put(i - 1, i, entry_2);
    put(i - 1, i - 1, t2);
  }
}

// put(row, column, value) for the second derivatives of H, repeated entries to be added.
template <class Put>
inline void masses([[maybe_unused]] const Parameters& par, [[maybe_unused]] const Real* x,
                   Put put) {
  for (int i = 1; i <= 32; ++i) {
    put(i + 31, i + 31, 1.0);
  }
}

// Many steps: start values are extrapolated, rounding errors of the updates carried along.
class Propagator {
 public:
  Propagator([[maybe_unused]] const Parameters& par, Real h, const State& z)
      : par_(par), h_(h), z_(z), alpha_(0.5), beta_(0.0), gamma_(0.0) {
    clear(bar_);
    clear(gradient_);
    kinetic_gradient(par_, bar_, gradient_);
    for (int i = 0; i < n; ++i) drift_[i] = gradient_[n + i];
    masses(par_, bar_, [&](int row, int, Real value) { mass_[row - n] += value; });
    for (int i = 0; i < n; ++i) {
      const Real inverse = alpha_ * (1 - alpha_) * mass_[i] / (1 + h_ * beta_ * mass_[i]);
      scale_[i] = h_ * (h_ * inverse - gamma_);
    }
  }

  // One step; on failure the state stays as it was.
  StepReport step() {
    StepReport report;
    const bool known = history_.known > 0;
    if (known) {
      history_.extrapolate(start_);
      for (int i = 0; i < unknowns; ++i) bar_[i] = start_[i];
    } else {
      start_at_state();
    }
    bool solved = iterate(report);
    if (!solved && known) {
      // Extrapolation may lead astray, the state itself seldom does.
      rule_ = NewtonRule();
      history_ = History();
      start_at_state();
      solved = iterate(report);
    }
    if (!solved) return report;
    for (int i = 0; i < unknowns; ++i) start_[i] = bar_[i];
    const int iterations = report.iterations;
    report = update();
    report.iterations = iterations;
    if (report.converged) history_.record(start_);
    return report;
  }

  // Up to `steps` steps; stops at the first failure.  The report sums the iterations.
  StepReport advance(long long steps) {
    StepReport total;
    total.converged = true;
    for (long long i = 0; i < steps && total.converged; ++i) {
      const StepReport report = step();
      total.iterations += report.iterations;
      total.increment = report.increment;
      total.converged = report.converged;
    }
    return total;
  }

  [[nodiscard]] const State& state() const { return z_; }

 private:
  static void clear(Real (&values)[2 * n]) {
    for (Real& value : values) value = 0;
  }
  void start_at_state() {
    for (int i = 0; i < n; ++i) {
      bar_[i] = z_.q[i];
      bar_[n + i] = z_.p[i];
    }
  }
  // Newton's iteration from bar_; the torn momenta follow from the coordinates.
  bool iterate(StepReport& report) {
    rule_.begin();
    for (int iteration = 1;; ++iteration) {
      ++report.iterations;
      evaluate();
      for (int i = 0; i < n; ++i) {
        residual_[i] = bar_[i] - z_.q[i] - h_ * (alpha_ * gradient_[n + i] + gamma_ * gradient_[i]);
      }
      {
        matrix_.clear();
        for (int i = 0; i < n; ++i) matrix_.put(i, i, 1);
        hessian(par_, bar_, [&](int row, int column, Real value) {
          matrix_.put(row, column, scale_[row] * value);
        });
        if (!matrix_.factorise()) break;
      }
      matrix_.solve(residual_);
      Real size = 0;
      Real scale = 0;
      for (int i = 0; i < n; ++i) {
        size += magnitude(residual_[i]);
        scale += magnitude(bar_[i]) + magnitude(z_.q[i]);
        bar_[i] -= residual_[i];
      }
      report.increment = size;
      const Verdict verdict = rule_(size, scale, iteration);
      if (verdict == Verdict::go_on) continue;
      if (verdict == Verdict::failed) break;
      evaluate();
      return true;
    }
    return false;
  }

  // The gradient at bar_, whose momenta are made from its coordinates.
  void evaluate() {
    clear(gradient_);
    potential_gradient(par_, bar_, gradient_);
    for (int i = 0; i < n; ++i) {
      const Real momentum = z_.p[i] - h_ * ((1 - alpha_) * gradient_[i] + beta_ * drift_[i]);
      bar_[n + i] = momentum / (1 + h_ * beta_ * mass_[i]);
    }
    kinetic_gradient(par_, bar_, gradient_);
  }

  // Z = z + h J grad H(zbar).
  StepReport update() {
    StepReport report;
    Real length = 0;
    for (const Real g : gradient_) length += h_ * g * (h_ * g);
    report.converged = length <= 1.0e308;
    if (!report.converged) {
      report.increment = length;
      return report;
    }
    for (int i = 0; i < n; ++i) {
      add(z_.q[i], carry_.q[i], h_ * gradient_[n + i]);
      add(z_.p[i], carry_.p[i], -h_ * gradient_[i]);
    }
    return report;
  }

  Parameters par_;
  Real h_;
  State z_;
  State carry_;
  Real bar_[2 * n] = {};
  Real gradient_[2 * n] = {};
  static constexpr int unknowns = History::unknowns;
  Real alpha_, beta_, gamma_;
  Real mass_[n] = {}, drift_[n] = {}, scale_[n] = {};
  BandMatrix matrix_;
  Real residual_[n] = {};
  NewtonRule rule_;
  History history_;
  Real start_[unknowns] = {};
};

}  // namespace fput::implicit_midpoint
