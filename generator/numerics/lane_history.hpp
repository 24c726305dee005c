// Solutions of earlier steps, extrapolated by polynomials, as for one trajectory (history.hpp); the
// degree is chosen in each lane.  With s_d the prediction of degree d and x the solution that came,
// the next predictions are
//   (d + 1) x - s_0 - ... - s_(d-1).
// None depends on one of the same or a higher degree: degrees that other lanes know and a lane does
// not change nothing in it.
template <int Unknowns>
struct History {
  static constexpr int degrees = Unknowns > 32 ? 8 : 16;
  Real predicted[degrees][Unknowns] = {};
  Real known = 0;  // degrees that are kept up to date
  Real best = 0;
  Mask growing = true;  // lanes that try one more degree: they choose at every step
  int age = 15;
  int fewest = 0, most = 0;     // of `known` in all lanes
  int lowest = 0, highest = 0;  // of `best`

  void record(const Real (&solution)[Unknowns]) {
    age = (age + 1) % 16;
    if (age == 0) {
      choose(true, solution);
    } else if (any(growing)) {
      choose(growing, solution);
    }
    Real sum[Unknowns] = {};
    Real number = 0;
    for (int degree = 0; degree < most; ++degree) {
      number += 1;
      for (int i = 0; i < Unknowns; ++i) {
        const Real kept = predicted[degree][i];
        predicted[degree][i] = number * solution[i] - sum[i];
        sum[i] += kept;
      }
    }
  }
  void choose(const Mask& lanes, const Real (&solution)[Unknowns]) {
    Real least = 0;
    for (int degree = 0; degree < most; ++degree) {
      const Real now = error_of(degree, solution, 0, Unknowns);
      const Mask better = degree == 0 ? lanes : lanes & (known > degree) & (now < least);
      least = select(better, now, least);
      best = select(better, Real(degree), best);
    }
    const Mask fewer = lanes & (best + 2 < known);
    growing = lanes & !fewer & (known < degrees);
    known = select(fewer, known - 1, select(growing, known + 1, known));
    range_of(known, fewest, most);
    range_of(best, lowest, highest);
  }
  static void range_of(const Real& numbers, int& least, int& largest_one) {
    least = largest_one = int(numbers[0]);
    for (int lane = 1; lane < lanes_of(numbers); ++lane) {
      const int number = int(numbers[lane]);
      least = number < least ? number : least;
      largest_one = number > largest_one ? number : largest_one;
    }
  }
  // The difference of order degree + 1 at the solution that came, of lower order if fewer steps are
  // known, and 0 if none is: summed over `count` unknowns.
  Real error(int degree, const Real (&solution)[Unknowns], int first, int count) const {
    Real result = 0;
    for (int d = fewest > degree ? degree
                 : fewest > 0    ? fewest - 1
                                 : 0;
         d <= degree && d < most; ++d) {
      result = select(known > d, error_of(d, solution, first, count), result);
    }
    return result;
  }
  Real error_of(int degree, const Real (&solution)[Unknowns], int first, int count) const {
    Real sum_of_errors = 0;
    for (int i = first; i < first + count; ++i) {
      sum_of_errors += magnitude(solution[i] - predicted[degree][i]);
    }
    return sum_of_errors;
  }
  void extrapolate(Real (&solution)[Unknowns]) const {
    for (int i = 0; i < Unknowns; ++i) {
      Real value = predicted[lowest][i];
      for (int degree = lowest + 1; degree <= highest; ++degree) {
        value = select(best >= degree, predicted[degree][i], value);
      }
      solution[i] = value;
    }
  }
};
template <int Unknowns>
void forget(History<Unknowns>& history) {
  history.known = 0;
  history.best = 0;
  history.growing = true;
  history.age = 15;
  history.fewest = history.most = 0;
  history.lowest = history.highest = 0;
}
