// value + carry = value + increment + rest, for an increment that is not small and a rest that is,
// with the old carry in it: the new carry is what the rounded sums of all three lose.  That of the
// first is exact where the rest is the smaller of the two, else to the last place of the carry.
inline void two_sum_with_rest(Real& value, Real& carry, Real increment, Real rest) {
  const Real moved = increment + rest;
  const Real lost = rest - (moved - increment);
  two_sum(value, carry, moved);
  carry += lost;
}
