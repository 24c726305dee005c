// *value += increment; what rounding loses is added to *lost.
static inline void collect(Real* value, Real* lost, Real increment) {
  Real error = 0;
  two_sum(value, &error, increment);
  *lost += error;
}
