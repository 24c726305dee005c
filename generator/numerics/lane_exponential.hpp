// exp x, cosh x and sinh x by one reduction: x = n log 2 + r, abs(r) <= log(2)/2.
template <class V>
struct Exponent {
  V n;
  Pair<V> remainder;
};
// Of abs(x) < 2000; log 2 in two parts, of 42 and 53 bits.
template <class V>
inline Exponent<V> exponent_of(V x) {
  const V n = nearest_integer(x * 0x1.71547652b82fep+0);
  const V most = x - n * 0x1.62e42fefa3800p-1;
  return {n, sum_with_larger(most, -(n * 0x1.ef35793c76730p-45))};
}
// exp r, exp -r, and sinh r.
template <class V>
struct Exponentials {
  Pair<V> plus, minus, sine;
};
template <class V>
inline Exponentials<V> exponentials(Pair<V> r) {
  const V z = r.high * r.high;
  const V w = z * z;
  // 1/6 in two parts.
  const V more =
      z * polynomial(w, 0.008333333333333335, 2.7557319259699533e-06, 1.6089985404780343e-10) +
      (w * polynomial(w, 0.00019841269841257354, 2.5052060244539124e-08) + 0x1.5555555555555p-57);
  const V even =
      polynomial(w, 0.041666666666666685, 2.4801587349135032e-05, 2.092173760498066e-09) +
      z * polynomial(w, 0.00138888888888733, 2.7557251901938335e-07);
  const V cube = r.high * z;
  const V third = cube * 0x1.5555555555555p-3;
  const V half = 0.5 * z;
  const V cosine = half + (w * even + (r.high + third) * r.low);  // - 1
  const V sine = third + (cube * more + (1 + half) * r.low);      // - r
  const Pair<V> plus = sum_with_larger(V() + 1, r.high);
  const Pair<V> minus = sum_with_larger(V() + 1, -r.high);
  return {{plus.high, plus.low + (cosine + sine)},
          {minus.high, minus.low + (cosine - sine)},
          {r.high, sine}};
}
template <class V>
inline V clamped(V x, double low, double high) {
  x = x < V() + low ? V() + low : x;
  return x > V() + high ? V() + high : x;
}
// exp(x + low)
template <class V>
inline V exponential(V x, V low) {
  const V at = clamped(x, -746, 710);
  const Exponent<V> exponent = exponent_of(at);
  const Pair<V> whole = {exponent.remainder.high, exponent.remainder.low + (at == x ? low : V())};
  const Pair<V> value = exponentials(normal(whole)).plus;
  return scaled(value.high + value.low, exponent.n);
}
template <class V>
inline V lane_exp(V x) {
  return exponential(x, V());
}
// 2^(1-n) sinh abs(x) and 2^(1-n) cosh x.
template <class V>
struct HyperbolicValues {
  V n;
  Pair<V> sine, cosine;
};
template <class V>
inline HyperbolicValues<V> hyperbolic_values(V x, double most) {
  const Exponent<V> exponent = exponent_of(clamped(lane_abs(x), 0, most));
  const Exponentials<V> values = exponentials(exponent.remainder);
  const V n = exponent.n > V() + 60 ? V() + 60 : exponent.n;
  const V small = power_of_two(-2 * n);
  const Pair<V> minus = {small * values.minus.high, small * values.minus.low};
  const Pair<V> sum = exact_sum(values.plus.high, minus.high);
  const Pair<V> difference = exact_sum(values.plus.high, -minus.high);
  const Pair<V> sine = {difference.high, difference.low + (values.plus.low - minus.low)};
  const Pair<V> twice = {2 * values.sine.high, 2 * values.sine.low};
  return {exponent.n,
          select<V>(exponent.n == V(), twice, sine),
          {sum.high, sum.low + (values.plus.low + minus.low)}};
}
template <class V>
inline V lane_sinh(V x) {
  const HyperbolicValues<V> values = hyperbolic_values(x, 720);
  return with_sign_of(scaled(values.sine.high + values.sine.low, values.n - 1), x);
}
template <class V>
inline V lane_cosh(V x) {
  const HyperbolicValues<V> values = hyperbolic_values(x, 720);
  return scaled(values.cosine.high + values.cosine.low, values.n - 1);
}
template <class V>
inline V lane_tanh(V x) {
  const HyperbolicValues<V> values = hyperbolic_values(x, 40);
  const Pair<V> ratio = quotient(normal(values.sine), normal(values.cosine));
  return with_sign_of(ratio.high + ratio.low, x);
}
template <int W>
inline Pack<W> lane_exp(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_exp(x); }, a);
}
template <int W>
inline Pack<W> lane_sinh(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_sinh(x); }, a);
}
template <int W>
inline Pack<W> lane_cosh(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_cosh(x); }, a);
}
template <int W>
inline Pack<W> lane_tanh(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_tanh(x); }, a);
}
