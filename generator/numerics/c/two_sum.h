// *value += increment; what rounding loses is left in *carry (two-sum of Knuth).
static inline void two_sum(Real* value, Real* carry, Real increment) {
  const Real sum = *value + increment;
  const Real part = sum - *value;
  *carry = (*value - (sum - part)) + (increment - part);
  *value = sum;
}
