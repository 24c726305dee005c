// *value + *carry = *value + increment + rest, for an increment that is not small and a rest that
// is, with the old carry in it: the new carry is what the rounded sums of all three lose.
static inline void two_sum_with_rest(Real* value, Real* carry, Real increment, Real rest) {
  Real lost = 0;
  two_sum(&increment, &lost, rest);
  two_sum(value, carry, increment);
  *carry += lost;
}
