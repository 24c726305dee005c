// x = 2^exponent (1 + fraction) for x > 0, with 1 + fraction between sqrt(1/2) and sqrt 2.
template <class V>
struct Mantissa {
  V exponent, fraction;
};
template <class V>
inline Mantissa<V> mantissa_of(V x) {
  const MaskOf<V> subnormal = x < V() + 0x1p-1022;
  x = subnormal ? x * 0x1p54 : x;
  const BitsOf<V> bits = bits_of(x);
  const V above = number_of<V>((bits >> 52 & 0x7ff) | 0x4330000000000000ULL);  // 2^52 + 1023 + k
  const V m = number_of<V>((bits & (~0ULL >> 12)) | 0x3ff0000000000000ULL);
  const MaskOf<V> high = m > V() + 0x1.6a09e667f3bcdp+0;
  const V exponent = above - (subnormal ? V() + (0x1p52 + 1077) : V() + (0x1p52 + 1023));
  return {high ? exponent + 1 : exponent, (high ? 0.5 * m : m) - 1};
}
// log(2^k (1 + f)), f.low a small correction:
//   log(1 + f) = f - f^2/2 + s (f^2/2 + z P(z)),  s = f/(2 + f), z = s^2, artanh s = s + s z
//   P(z)/2,
// f^2/2 in two parts, the first one exact.
//
// Note [where a constant is added]
// What log 2 lacks is added to what has random digits below the last one of the sum.  Added to a
// sum that is rounded already it would turn its rounding to one side, by up to 1/50 of a last
// place.
template <class V>
inline V logarithm(V k, Pair<V> f) {
  const V x = f.high;
  const V s = x / (2 + x);
  const V z = s * s;
  const V w = z * z;
  // 2/3 in two parts.
  const V more = z * polynomial(w, 0.39999999999999974, 0.22222222217215662, 0.15384554830366254,
                                0.11673527832353815) +
                 (w * polynomial(w, 0.28571428571446683, 0.18181818904281935, 0.13336387637309277,
                                 0.11998844174713265) +
                  0x1.5555555555555p-55);
  const V p = more + 0x1.5555555555555p-1;
  const V x_high = number_of<V>(bits_of(x) & (~0ULL << 27));
  const V half_high = 0.5 * (x_high * x_high);
  const V half_low = 0.5 * ((x - x_high) * (x + x_high));
  const Pair<V> first = sum_with_larger(k * 0x1.62e42fefa3800p-1, x);
  const Pair<V> most = sum_with_larger(first.high, -half_high);
  const V slope = f.low - f.low * (x - 2 * half_high);
  const V rest = (slope - half_low) + (most.low + (first.low + k * 0x1.ef35793c76730p-45));
  return most.high + (s * ((half_high + half_low) + z * p) + rest);
}
template <class V>
inline V lane_log(V x) {
  constexpr double infinity = __builtin_inf();
  const Mantissa<V> m = mantissa_of(x);
  V value = logarithm(m.exponent, Pair<V>{m.fraction, V()});
  value = x < V() + infinity ? value : x;  // and NaN
  value = x == V() ? V() - infinity : value;
  return x < V() ? V() + __builtin_nan("") : value;
}
// log(1 + u) or, of what is more than 1, log(2^k u).
template <class V>
inline V logarithm_of_sum(Pair<V> sum, V k) {
  const Mantissa<V> m = mantissa_of(sum.high);
  const V unit = power_of_two(m.exponent > V() + 1000 ? V() - 1000 : -m.exponent);
  return logarithm(m.exponent + k, exact_sum(m.fraction, unit * sum.low));
}
template <class V>
inline Pair<V> one_plus(Pair<V> u) {
  const Pair<V> sum = exact_sum(V() + 1, u.high);
  return {sum.high, sum.low + u.low};
}
// asinh x = log(1 + x + x^2/(1 + sqrt(1 + x^2))) for x > 0.
template <class V>
inline V lane_asinh(V x) {
  const V size = lane_abs(x);
  const MaskOf<V> large = size > V() + 0x1p28;
  const V at = large ? V() + 1 : size;
  const Pair<V> square = exact_product(at, at);
  const Pair<V> length = root(one_plus(square));
  const Pair<V> under = sum_with_larger(length.high, V() + 1);
  const Pair<V> rest = quotient(square, Pair<V>{under.high, under.low + length.low});
  const Pair<V> sum = exact_sum(at, rest.high);
  const Pair<V> whole = one_plus(Pair<V>{sum.high, sum.low + rest.low});
  const V value = logarithm_of_sum(select<V>(large, {size, V()}, whole), large ? V() + 1 : V());
  return with_sign_of(size < V() + __builtin_inf() ? value : size, x);
}
// acosh x = log(1 + t + sqrt(t (t + 2))), t = x - 1.
template <class V>
inline V lane_acosh(V x) {
  const MaskOf<V> large = x > V() + 0x1p28;
  const V at = large ? V() + 2 : x;
  const Pair<V> t = exact_sum(at, V() - 1);
  const Pair<V> next = exact_sum(at, V() + 1);
  const Pair<V> product = exact_product(t.high, next.high);
  const Pair<V> length =
      root(Pair<V>{product.high, product.low + (t.high * next.low + t.low * next.high)});
  const Pair<V> sum = exact_sum(t.high, length.high);
  const Pair<V> whole = one_plus(Pair<V>{sum.high, sum.low + (t.low + length.low)});
  const V value = logarithm_of_sum(select<V>(large, {x, V()}, whole), large ? V() + 1 : V());
  const V outside = x < V() + 1 ? V() + __builtin_nan("") : x;
  return x >= V() + 1 ? (x < V() + __builtin_inf() ? value : x) : outside;
}
// atanh x = log(1 + 2 x/(1 - x))/2 for x > 0.
template <class V>
inline V lane_atanh(V x) {
  const V size = lane_abs(x);
  const MaskOf<V> inside = size < V() + 1;
  const V at = inside ? size : V();
  const Pair<V> ratio = quotient(Pair<V>{2 * at, V()}, sum_with_larger(V() + 1, -at));
  const V value = 0.5 * logarithm_of_sum(one_plus(ratio), V());
  const V outside = size == V() + 1 ? V() + __builtin_inf() : V() + __builtin_nan("");
  return with_sign_of(inside ? value : outside, x);
}
template <int W>
inline Pack<W> lane_log(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_log(x); }, a);
}
template <int W>
inline Pack<W> lane_asinh(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_asinh(x); }, a);
}
template <int W>
inline Pack<W> lane_acosh(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_acosh(x); }, a);
}
template <int W>
inline Pack<W> lane_atanh(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_atanh(x); }, a);
}
