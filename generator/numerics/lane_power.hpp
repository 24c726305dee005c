// log x to twice the length, relative to 2^-66: s = f/(2 + f) and 2 artanh s = 2 s + s^3 P(s^2).
template <class V>
inline Pair<V> long_logarithm(V x) {
  const Mantissa<V> m = mantissa_of(x);
  const Pair<V> s = quotient(Pair<V>{m.fraction, V()}, sum_with_larger(V() + 2, m.fraction));
  const Pair<V> square = exact_product(s.high, s.high);
  const V z = square.high;
  const V w = z * z;
  const V rest = polynomial(w, 0.39999999999999974, 0.22222222217215662, 0.15384554830366254,
                            0.11673527832353815) +
                 z * polynomial(w, 0.28571428571446683, 0.18181818904281935, 0.13336387637309277,
                                0.11998844174713265);
  const Pair<V> p = sum_with_larger(V() + 0x1.5555555555555p-1, z * rest);
  const Pair<V> cube = exact_product(s.high, z);
  const V cube_low = cube.low + (s.high * (square.low + 2 * s.high * s.low) + s.low * z);
  const Pair<V> term = exact_product(cube.high, p.high);
  const V term_low = term.low + (cube.high * (p.low + 0x1.5555555555555p-55) + cube_low * p.high);
  const Pair<V> most = sum_with_larger(2 * s.high, term.high);
  const Pair<V> all = sum_with_larger(m.exponent * 0x1.62e42fefa3800p-1, most.high);
  const V low = most.low + (2 * s.low + term_low);
  return normal(Pair<V>{all.high, all.low + (low + m.exponent * 0x1.ef35793c76730p-45)});
}
// x^y, in all cases that of the C library.
template <class V>
inline V lane_pow(V x, V y) {
  constexpr double infinity = __builtin_inf();
  const V size = lane_abs(x);
  const V power = clamped(y, -0x1p66, 0x1p66);
  const Pair<V> log = long_logarithm(size);
  const Pair<V> product = exact_product(power, log.high);
  V value = exponential(product.high, product.low + power * log.low);
  // 0 and infinity behave as what is less and more than 1.
  const V bound = (size > V() + 1) == (y > V()) ? V() + infinity : V();
  value = size == V() ? bound : (size == V() + infinity ? bound : value);
  const V y_size = lane_abs(y);
  const V half = 0.5 * y_size;
  const MaskOf<V> whole = y_size < V() + 0x1p52 ? (y_size + 0x1p52) - 0x1p52 == y_size : y == y;
  const MaskOf<V> odd = y_size < V() + 0x1p53 ? (half + 0x1p52) - 0x1p52 != half : y != y;
  const V of_negative =
      whole ? (odd ? -value : value) : (x == V() - infinity ? value : V() + __builtin_nan(""));
  const V of_zero = whole ? of_negative : value;
  value = with_sign_of(V() + 1, x) < V() ? (x == V() ? of_zero : of_negative) : value;
  value = x == x ? (y == y ? value : y) : x;
  value = y == V() ? V() + 1 : value;
  return x == V() + 1 ? V() + 1 : value;
}
template <int W>
inline Pack<W> lane_pow(const Pack<W>& a, const Pack<W>& b) {
  return lanewise<W>([](auto x, auto y) { return lane_pow(x, y); }, a, b);
}
template <int W>
inline Pack<W> lane_pow(const Pack<W>& a, double b) {
  return lane_pow(a, Pack<W>(b));
}
template <int W>
inline Pack<W> lane_pow(double a, const Pack<W>& b) {
  return lane_pow(Pack<W>(a), b);
}
