// Solutions of earlier steps, extrapolated by polynomials.  With s_d the prediction of degree d
// and x the solution that came, the next predictions are
//   (d + 1) x - s_0 - ... - s_(d-1).
// The degree is chosen anew every 16th step: the one that predicted best that time.  As long as
// that is one of the highest known, the next one is tried.
typedef struct {
  Real predicted[Degrees][Unknowns];
  Real sum[Unknowns];
  int known;  // degrees that are kept up to date
  int best;
  int age;
} History;
static inline void History_forget(History* history) {
  history->known = 0;
  history->best = 0;
  history->age = 15;
}
// The difference of order degree + 1 at the solution that came, of lower order if fewer steps are
// known, and 0 if none is: summed over `count` unknowns, each in its own unit, one over so much, or
// all in the same one.
static inline Real History_error(const History* history, int degree, const Real* solution,
                                 int first, int count, const Real* unit) {
  if (history->known == 0) return 0;
  if (degree >= history->known) degree = history->known - 1;
  Real sum_of_errors = 0;
  for (int i = first; i < first + count; ++i) {
    const Real gap = magnitude(solution[i] - history->predicted[degree][i]);
    sum_of_errors += unit ? gap * unit[i - first] : gap;
  }
  return sum_of_errors;
}
static inline void History_choose(History* history, const Real* solution) {
  history->age = 0;
  Real least = 0;
  for (int degree = 0; degree < history->known; ++degree) {
    const Real now = History_error(history, degree, solution, 0, Unknowns, 0);
    if (degree == 0 || now < least) {
      least = now;
      history->best = degree;
    }
  }
  if (history->best + 2 < history->known) {
    --history->known;
  } else if (history->known < Degrees) {
    ++history->known;
    history->age = 15;
  }
}
static inline void History_record(History* history, const Real* solution) {
  if (++history->age == 16) History_choose(history, solution);
  for (int i = 0; i < Unknowns; ++i) history->sum[i] = 0;
  for (int degree = 0; degree < history->known; ++degree) {
    for (int i = 0; i < Unknowns; ++i) {
      const Real kept = history->predicted[degree][i];
      history->predicted[degree][i] = (Real)(degree + 1) * solution[i] - history->sum[i];
      history->sum[i] += kept;
    }
  }
}
static inline void History_extrapolate(const History* history, Real* solution) {
  for (int i = 0; i < Unknowns; ++i) solution[i] = history->predicted[history->best][i];
}
// The solution of a step, from the unknown `first` on, before the history records it.
static inline void History_watch(const History* history, NewtonRule* rule, const Real* solution,
                                 int first, int count) {
  const Real* unit = count > 1 ? rule->unit : 0;
  if (unit) NewtonRule_follow(rule, solution + first, count);
  if (unit && rule->fresh > 0) {
    --rule->fresh;
    rule->unchecked += 32;
  }
  if (unit && rule->power == 2 && 1024 * rule->contraction < 1) rule->contraction = (Real)1 / 1024;
  rule->move = History_error(history, 0, solution, first, count, unit);
  rule->bend = History_error(history, rule->power + 1, solution, first, count, unit);
  for (int j = 0; unit && j < count; ++j) {
    rule->moves[j] = History_error(history, 0, solution, first + j, 1, 0);
    rule->bends[j] = History_error(history, rule->power + 1, solution, first + j, 1, 0);
  }
}
