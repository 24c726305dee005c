// What the polynomial that predicts the next solution says of the one after it: with s_d the next
// one's predictions and D the degree it is taken of,
//   (D + 1) s_D - s_0 - ... - s_(D-1),
// which is how History goes on where s_D itself is the solution that comes.
static inline void History_extrapolate_twice(const History* history, Real* solution) {
  const int best = history->best;
  for (int i = 0; i < Unknowns; ++i) {
    Real sum = 0;
    for (int degree = 0; degree < best; ++degree) sum += history->predicted[degree][i];
    solution[i] = (Real)(best + 1) * history->predicted[best][i] - sum;
  }
}
