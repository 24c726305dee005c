template <int W>
inline Pack<W / 2> half_of(const Pack<W>& a, int half) {
  double x[W];
  a.copy_to(x);
  return Pack<W / 2>::at(x + W / 2 * half);
}
// a + b, and what that loses.
template <class Number>
inline Number collected(const Number& a, const Number& b, Number& lost) {
  const Number sum = a + b;
  const Number part = sum - a;
  lost += (a - (sum - part)) + (b - part);
  return sum;
}
// Half of the numbers are added to the other half until one is left.
template <int W>
inline void collect_halves(double& value, double& lost, const Pack<W>& sum, const Pack<W>& rest) {
  if constexpr (W == 2) {
    double more = rest[0] + rest[1];
    value = collected(sum[0], sum[1], more);
    lost += more;
  } else {
    Pack<W / 2> more = half_of(rest, 0) + half_of(rest, 1);
    const Pack<W / 2> half = collected(half_of(sum, 0), half_of(sum, 1), more);
    collect_halves(value, lost, half, more);
  }
}
// value = the sum of `count` slopes from one of them on.  What rounding loses of it, and their
// changes, are added to lost.
template <class Lanes, class Refinement>
inline void collect_stages(double& value, double& lost,
                           const RefinementInLanes<Lanes, Refinement>& refined, int first,
                           int count) {
  constexpr int width = RefinementInLanes<Lanes, Refinement>::width;
  Lanes sum = Lanes::at(refined.slope + first);
  Lanes rest = Lanes::at(refined.change + first);
  for (int j = first + width; j < first + count; j += width) {
    rest += Lanes::at(refined.change + j);
    sum = collected(sum, Lanes::at(refined.slope + j), rest);
  }
  collect_halves(value, lost, sum, rest);
}
