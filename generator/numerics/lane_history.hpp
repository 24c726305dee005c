// Solutions of earlier steps, extrapolated by polynomials, as for one trajectory (history.hpp); the
// degree is chosen in each lane.  With x_0, x_1, ... the last solutions, the newest first, the
// prediction of degree d is
//   (d + 1) x_0 - (d + 1 over 2) x_1 + (d + 1 over 3) x_2 - ...
// and its error, once the solution came, a backward difference.  The weights of a lane beyond its
// degree are 0 and add nothing to what the others sum up to: what other lanes need changes no bit.
template <int Unknowns>
struct History {
  static constexpr int degrees = Unknowns > 32 ? 8 : 16;
  Real past[2 * degrees][Unknowns] = {};  // each solution twice, so that the last stand in a row
  Real weight[degrees] = {1.0};
  Real best = 0;
  int newest = 0;  // x_k is past[newest + k]
  int known = 0;   // of them
  int age = 0;
  int highest = 0;  // of `best` in all lanes

  void record(const Real (&solution)[Unknowns]) {
    age = (age + 1) % 32;
    if (age == 0 || known < degrees) choose(solution);
    if (known < degrees) ++known;
    newest = newest == 0 ? degrees - 1 : newest - 1;
    for (int i = 0; i < Unknowns; ++i) past[newest][i] = past[newest + degrees][i] = solution[i];
  }
  // The degree that would have been the best, at most two higher than the last one.  Seldom done,
  // and no part of a step's code.
  __attribute__((noinline)) void choose(const Real (&solution)[Unknowns]) {
    const int tried = highest + 3 < known ? highest + 3 : known;
    Real errors[degrees] = {};
    for (int i = 0; i < Unknowns; ++i) {
      Real differences[degrees + 1] = {solution[i]};
      for (int k = 0; k < tried; ++k) differences[k + 1] = past[newest + k][i];
      for (int degree = 0; degree < tried; ++degree) {
        for (int k = 0; k < tried - degree; ++k) differences[k] -= differences[k + 1];
        errors[degree] += magnitude(differences[0]);
      }
    }
    Real chosen = 0;
    Real least = errors[0];
    for (int degree = 1; degree < tried; ++degree) {
      const Mask better = (errors[degree] < least) & (best + 3 > degree);
      least = select(better, errors[degree], least);
      chosen = select(better, Real(degree), chosen);
    }
    if (!all(chosen == best)) use(chosen);
  }
  void use(const Real& chosen) {
    best = chosen;
    highest = 0;
    for (int lane = 0; lane < lanes_of(best); ++lane) {
      const int degree = int(best[lane]);
      highest = degree > highest ? degree : highest;
    }
    Real binomial = 1;
    for (int k = 0; k < degrees; ++k) {
      binomial = binomial * (best + 1 - k) / (k + 1);
      weight[k] = k % 2 == 0 ? binomial : -binomial;
    }
  }
  // The difference of order Degree + 1 at the solution that came, of lower order if fewer steps are
  // known, and 0 if none is: of one unknown, or summed over `count` of them.
  template <int Degree>
  Real difference(const Real (&solution)[Unknowns], int i) const {
    if (known <= Degree) {
      if constexpr (Degree > 0) return difference<Degree - 1>(solution, i);
      return 0;
    }
    Real all = solution[i];
    double binomial = 1;
    for (int k = 0; k <= Degree; ++k) {
      binomial = -binomial * (Degree + 1 - k) / (k + 1);
      all += binomial * past[newest + k][i];
    }
    return magnitude(all);
  }
  // The way of one unknown since the last step.
  Real way(const Real (&solution)[Unknowns], int i) const {
    return known == 0 ? Real(0) : solution[i] - past[newest][i];
  }
  template <int Degree>
  Real error(const Real (&solution)[Unknowns], int first, int count) const {
    Real total = 0;
    for (int i = first; i < first + count; ++i) total += difference<Degree>(solution, i);
    return total;
  }
  void extrapolate(Real (&solution)[Unknowns]) const {
    int first = 0;
    for (; first + block < Unknowns; first += block) extrapolate_part<block>(solution, first);
    extrapolate_part<(Unknowns - 1) % block + 1>(solution, first);
  }
  // Of many unknowns so many are looked at together: what a sum has reached stays near.
  static constexpr int block = Unknowns > 64 ? 64 : Unknowns;
  template <int Count>
  void extrapolate_part(Real (&solution)[Unknowns], int first) const {
    Real sum[Count] = {};
    for (int k = 0; k <= highest; k += 2) {
      for (int i = 0; i < Count; ++i)
        sum[i] += weight[k] * past[newest + k][first + i] +
                  weight[k + 1] * past[newest + k + 1][first + i];
    }
    for (int i = 0; i < Count; ++i) solution[first + i] = sum[i];
  }
};
template <int Unknowns>
void forget(History<Unknowns>& history) {
  for (auto& solution : history.past) {
    for (Real& value : solution) value = 0;
  }
  history.newest = history.known = history.age = 0;
  history.use(0);
}
