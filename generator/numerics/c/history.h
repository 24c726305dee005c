// Solutions of earlier steps, extrapolated by polynomials.  With s_d the prediction of degree d
// and x the solution that came, the next predictions are
//   (d + 1) x - s_0 - ... - s_(d-1).
// The degree is chosen anew every 16th step: the one that predicted best that time, or a lower one
// that is enough for all that the solution serves.  As long as the best is one of the highest
// known, the next one is tried.
typedef struct {
  Real predicted[Degrees][Unknowns];
  Real sum[Unknowns];
  int known;  // degrees that are kept up to date
  int best;
  int age;
  int enough;  // a degree that is
  int asked;   // for so many unknowns
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
  const bool serves = history->asked == Unknowns;
  if (serves) history->best = history->enough;
  history->enough = history->asked = 0;
  if (serves) {
    if (history->best + 1 < history->known && history->known > 4) --history->known;
    return;
  }
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
// Is the degree of the predictions, or the one below it, enough for these unknowns, of which the
// slowest moves by so much?
static inline void History_ask(History* history, NewtonRule* rule, const Real* solution, int first,
                               int count, const Real* unit, Real move) {
  if (rule->missed > 1) {
    rule->margin = rule->margin < 16384 ? 64 * rule->margin : (Real)1048576;
  } else if (rule->margin > 8) {
    rule->margin = 7 * rule->margin / 8;
  }
  rule->missed = 0;
  const int best = history->best;
  for (int degree = best > 0 ? best - 1 : best; degree <= best; ++degree) {
    const Real missing = History_error(history, degree, solution, first, count, unit);
    const Real size = rule->margin * missing;
    const Real bend = rule->bend > size ? rule->bend : size;
    const bool straight = bend * size * size * 1024 <= rule->bend_limit * move * move;
    if (straight && rule->contraction * size * size * 1048576 <= rule->next_limit) {
      history->enough = degree > history->enough ? degree : history->enough;
      history->asked += count;
      return;
    }
  }
}
// The solution of a step, from the unknown `first` on, before the history records it.
static inline void History_watch(History* history, NewtonRule* rule, const Real* solution,
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
  if (rule->power == 1 || history->age < 15 || history->known < 4) return;
  Real slowest = unit ? largest : rule->move;
  for (int j = 0; unit && j < count; ++j) {
    const Real part = rule->moves[j] * unit[j];
    slowest = part < slowest ? part : slowest;
  }
  History_ask(history, rule, solution, first, count, unit, slowest);
}
