#include "generator/formats/cpp_support.hpp"

#include <fmt/format.h>

namespace hamgen {

std::string cpp_magnitude(const ScalarType& scalar, bool builtins) {
  std::string value = builtins ? fmt::format("__builtin_fabs{}(x)", scalar.digits == 24   ? "f"
                                                                    : scalar.digits == 64 ? "l"
                                                                                          : "")
                               : "std::fabs(x)";
  if (scalar.digits == 113) value = "x < 0 ? -x : x";
  return "inline Real magnitude(Real x) { return " + value + "; }\n";
}

std::string cpp_compensated_sum() {
  return R"(// value += increment, with what rounding loses kept in carry (two-sum of Knuth).
inline void add(Real& value, Real& carry, Real increment) {
  const Real wanted = increment + carry;
  const Real sum = value + wanted;
  const Real part = sum - value;
  carry = (value - (sum - part)) + (wanted - part);
  value = sum;
}
)";
}

std::string cpp_two_sum() {
  return R"(// value += increment; what rounding loses is left in carry (two-sum of Knuth).
inline void two_sum(Real& value, Real& carry, Real increment) {
  const Real sum = value + increment;
  const Real part = sum - value;
  carry = (value - (sum - part)) + (increment - part);
  value = sum;
}
)";
}

std::string cpp_sum_with_rest() {
  return R"(// value + carry = value + increment + rest: what the carry misses is as small against it as it is
// against the value.
inline void add(Real& value, Real& carry, Real increment, Real rest) {
  Real lost = 0;
  two_sum(increment, lost, rest);
  two_sum(value, carry, increment);
  carry += lost;
}
)";
}

std::string cpp_collected_sum() {
  return R"(// value += increment; what rounding loses is added to lost.
inline void collect(Real& value, Real& lost, Real increment) {
  Real error = 0;
  two_sum(value, error, increment);
  lost += error;
}
)";
}

std::string cpp_newton_rule(const ScalarType& scalar, bool simplified) {
  return fmt::format(R"(enum class Verdict {{ go_on, done, failed }};

// When to stop Newton's iteration: at round-off.  Increments shrink as
//   next <= contraction * {power_text},
// where the contraction is measured, kept from step to step and checked at least every 32nd step.
// The last increment still enters the solution, so an iteration may stop when the next one would
// be lost in rounding.  What is cut off is a bias where rounding is a random walk, and in the
// momenta it counts 1/h times: the factor 2^-20 keeps it below the sum of the rounding errors.
struct NewtonRule {{
  Real contraction = {largest};
  int unchecked = 0;
  Real previous = 0;
  int grown = 0;

  void begin() {{
    previous = 0;
    grown = 0;
  }}
  Verdict operator()(Real size, Real scale, int iterations) {{
    if (!(size <= {largest})) return Verdict::failed;
    const Real round_off = {epsilon} * scale;
    if (previous > 0) {{
      const Real seen = (size < round_off ? round_off : size) / {previous};
      // It may rise at once but falls slowly: one small increment may be luck.
      const bool first = contraction >= {largest};
      if (first || (size > 64 * round_off && seen > contraction)) {{
        contraction = seen;
      }} else if (seen < contraction) {{
        contraction = 4 * seen < contraction ? contraction / 4 : seen;
      }}
      unchecked = 0;
      // No progress twice in a row: this is round-off if it is small, else it may still recover.
      grown = size < previous ? 0 : grown + 1;
      if (grown >= 2 && size <= 4096 * round_off) return Verdict::done;
    }} else {{
      ++unchecked;
    }}
    if (size <= round_off) return Verdict::done;
    if (unchecked < 32 && contraction * {power} * 1048576 <= round_off) return Verdict::done;
    previous = size;
    return iterations < 60 ? Verdict::go_on : Verdict::failed;
  }}
}};
)",
                     fmt::arg("largest", scalar.largest), fmt::arg("epsilon", scalar.epsilon),
                     fmt::arg("power_text", simplified ? "size" : "size^2"),
                     fmt::arg("previous", simplified ? "previous" : "(previous * previous)"),
                     fmt::arg("power", simplified ? "size" : "size * size"));
}

std::string cpp_fixed_point_rule(const ScalarType& scalar) {
  return fmt::format(R"(enum class Progress {{ go_on, done, failed }};

// When to stop a fixed-point iteration: at stagnation with one second chance, that is when twice in
// a row no component's increment has been smaller than ever before.  A zero may be an accident and
// says nothing.  Even and odd iterations are compared among themselves: where q hangs on p and p on
// q alone they are two sequences, and one may be far ahead of the other.  The larger the last
// increment, the longer it must stand still: 64, 512, 4096 units of rounding after 2, 3, 4 times.
template <int Size>
struct FixedPointRule {{
  Real least[2][Size] = {{}};  // 0 before the first increment
  int stuck = 0;

  Progress operator()(const Real (&increment)[Size], Real scale, int iterations) {{
    bool decreased = false;
    Real size = 0;
    for (int i = 0; i < Size; ++i) {{
      Real& smallest = least[iterations % 2][i];
      const Real now = magnitude(increment[i]);
      if (now > 0 && (smallest <= 0 || now < smallest)) {{
        decreased = true;
        smallest = now;
      }}
      size += now;
    }}
    if (!(size <= {largest})) return Progress::failed;
    if (size <= 0) return Progress::done;
    // Among many components one always flickers: below their rounding together they are done too.
    const Real round_off = {epsilon} * scale;
    stuck = decreased && size * 8 > round_off ? 0 : stuck + 1;
    if (stuck >= 2 && size <= 64 * round_off) return Progress::done;
    if (stuck >= 3 && size <= 512 * round_off) return Progress::done;
    const bool small = size <= 4096 * round_off;
    if (stuck >= 4 && small) return Progress::done;
    if (iterations < 500) return Progress::go_on;
    return small ? Progress::done : Progress::failed;
  }}
}};
)",
                     fmt::arg("largest", scalar.largest), fmt::arg("epsilon", scalar.epsilon));
}

std::string cpp_history(int unknowns) {
  // Each degree is a copy of all unknowns: for many of them it must be worth its memory.
  const bool many = unknowns > 32;
  const std::string sum = "Real sum[unknowns] = {};\n";
  return fmt::format(
      R"(// Solutions of earlier steps, extrapolated by polynomials.  With s_d the prediction of degree d
// and x the solution that came, the next predictions are
//   (d + 1) x - s_0 - ... - s_(d-1).
// The degree is chosen anew every 16th step: the one that predicted best that time.  As long as
// that is one of the highest known, the next one is tried.
struct History {{
  static constexpr int unknowns = {unknowns};
  static constexpr int degrees = {degrees};
  Real predicted[degrees][unknowns] = {{}};
{member}  int known = 0;  // degrees that are kept up to date
  int best = 0;
  int age = 15;

  void record(const Real (&solution)[unknowns]) {{
    if (++age == 16) choose(solution);
{local}    for (int degree = 0; degree < known; ++degree) {{
      for (int i = 0; i < unknowns; ++i) {{
        const Real kept = predicted[degree][i];
        predicted[degree][i] = Real(degree + 1) * solution[i] - sum[i];
        sum[i] += kept;
      }}
    }}
  }}
  void choose(const Real (&solution)[unknowns]) {{
    age = 0;
    Real least = 0;
    for (int degree = 0; degree < known; ++degree) {{
      Real error = 0;
      for (int i = 0; i < unknowns; ++i) {{
        error += magnitude(solution[i] - predicted[degree][i]);
      }}
      if (degree == 0 || error < least) {{
        least = error;
        best = degree;
      }}
    }}
    if (best + 2 < known) {{
      --known;
    }} else if (known < degrees) {{
      ++known;
      age = 15;
    }}
  }}
  void extrapolate(Real (&solution)[unknowns]) const {{
    for (int i = 0; i < unknowns; ++i) solution[i] = predicted[best][i];
  }}
}};
)",
      fmt::arg("unknowns", unknowns), fmt::arg("degrees", many ? 8 : 16),
      fmt::arg("member", many ? "  " + sum : ""),
      fmt::arg("local", many ? "    for (Real& s : sum) s = 0;\n" : "    " + sum));
}

std::string cpp_elimination(const ScalarType&) {
  return R"(// Solves matrix x = vector in place by elimination with partial pivoting; false if singular.
template <int Size>
inline bool eliminate(Real (&matrix)[Size][Size], Real (&vector)[Size]) {
  for (int c = 0; c < Size; ++c) {
    int pivot = c;
    Real largest = 0;
    for (int r = c; r < Size; ++r) {
      const Real size = magnitude(matrix[r][c]);
      if (size > largest) {
        largest = size;
        pivot = r;
      }
    }
    if (!(largest > 0)) return false;
    if (pivot != c) {
      for (int j = c; j < Size; ++j) {
        const Real kept = matrix[c][j];
        matrix[c][j] = matrix[pivot][j];
        matrix[pivot][j] = kept;
      }
      const Real kept = vector[c];
      vector[c] = vector[pivot];
      vector[pivot] = kept;
    }
    const Real reciprocal = 1 / matrix[c][c];
    for (int r = c + 1; r < Size; ++r) {
      const Real factor = matrix[r][c] * reciprocal;
      for (int j = c + 1; j < Size; ++j) matrix[r][j] -= factor * matrix[c][j];
      vector[r] -= factor * vector[c];
    }
  }
  for (int r = Size - 1; r >= 0; --r) {
    for (int j = r + 1; j < Size; ++j) vector[r] -= matrix[r][j] * vector[j];
    vector[r] /= matrix[r][r];
  }
  return true;
}
)";
}

std::string cpp_inverse() {
  return R"(// The inverse of a matrix that stays the same for the whole run; false if singular.
template <int Size>
inline bool invert(const Real (&matrix)[Size][Size], Real (&inverse)[Size][Size]) {
  for (int c = 0; c < Size; ++c) {
    Real copy[Size][Size];
    Real column[Size];
    for (int i = 0; i < Size; ++i) {
      for (int j = 0; j < Size; ++j) copy[i][j] = matrix[i][j];
      column[i] = i == c ? 1 : 0;
    }
    if (!eliminate(copy, column)) return false;
    for (int i = 0; i < Size; ++i) inverse[i][c] = column[i];
  }
  return true;
}
)";
}

std::string cpp_eigen_solve() {
  return R"(// Solves matrix x = vector in place; the result is not finite if the matrix is singular.
template <int Size>
inline bool eliminate(Real (&matrix)[Size][Size], Real (&vector)[Size]) {
  using Matrix = Eigen::Matrix<Real, Size, Size, Eigen::RowMajor>;
  using Vector = Eigen::Matrix<Real, Size, 1>;
  Eigen::Map<Matrix> a(&matrix[0][0]);
  Eigen::Map<Vector> b(&vector[0]);
  const Vector solution = Eigen::PartialPivLU<Eigen::Ref<Matrix>>(a).solve(b);
  b = solution;
  return true;
}
)";
}

}  // namespace hamgen
