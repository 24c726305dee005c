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
