// sign arctan(n/d) + eighths pi/4, for 0 <= n <= d, d > 0.  For n/d above sqrt(2) - 1 it is
//   arctan(n/d) = pi/4 + arctan((n - d)/(n + d)).
template <class V>
inline V turned_arc(V n, V d, V sign, V eighths) {
  const MaskOf<V> large = n > d * 0x1.a827999fcef32p-2;
  const Pair<V> over = select<V>(large, exact_sum(n, -d), {n, V()});
  const Pair<V> under = select<V>(large, exact_sum(d, n), {d, V()});
  const Pair<V> t = quotient(over, under);
  const V z = t.high * t.high;
  const V w = z * z;
  const V p = polynomial(w, -0.3333333333333333, -0.14285714285640777, -0.09090908896940646,
                         -0.06666572328094916, -0.05251760479815706, -0.039888987769801355,
                         -0.011847916827953317) +
              z * polynomial(w, 0.19999999999999404, 0.1111111110628447, 0.07692302544547504,
                             0.058811281873244824, 0.046858892932562304, 0.02831185514443927);
  // Near the smallest numbers a quotient's correction has no digits.
  const V correction = lane_abs(t.high) < V() + 0x1p-900 ? V() : t.low;
  const V turns = eighths + (large ? sign : V());
  const Pair<V> sum = sum_with_larger(turns * 0x1.921fb54442d18p-1, sign * t.high);
  // See note [where a constant is added].
  const V rest = sign * (correction - correction * z) + (sum.low + turns * 0x1.1a62633145c07p-55);
  return sum.high + (sign * ((t.high * z) * p) + rest);
}
template <class V>
inline V lane_atan(V x) {
  V size = lane_abs(x);
  const MaskOf<V> large = size > V() + 1;
  size = size > V() + 0x1p200 ? V() + 0x1p200 : size;
  const V one = V() + 1;
  return with_sign_of(turned_arc(large ? one : size, large ? size : one, large ? -one : one,
                                 large ? one + one : V()),
                      x);
}
template <class V>
inline V lane_atan2(V y, V x) {
  constexpr double infinity = __builtin_inf();
  const V one = V() + 1;
  const V x_size = lane_abs(x);
  const V y_size = lane_abs(y);
  const MaskOf<V> steep = y_size > x_size;
  V n = steep ? x_size : y_size;
  V d = steep ? y_size : x_size;
  const MaskOf<V> endless = d == V() + infinity;
  n = endless ? (n == V() + infinity ? one : n - n) : n;
  d = endless ? one : (d == V() ? one : d);
  // d is brought to 2^900, or is below and multiplied by 2^1023: n is exact then, and nothing
  // overflows.
  const V inverse = number_of<V>((2946ULL << 52) - (bits_of(d) & (0x7ffULL << 52)));
  const V unit = d < one * 0x1p-120 ? one * 0x1p1023 : inverse;
  const MaskOf<V> left = with_sign_of(one, x) < V();
  const V sign = steep == left ? one : -one;
  const V eighths = steep ? one + one : (left ? one * 4 : V());
  return with_sign_of(turned_arc(n * unit, d * unit, sign, eighths), y);
}
// arcsin sqrt(z) for z up to 1/4, in three parts: t.high + beyond + low.
template <class V>
struct Arc {
  V high, beyond, low;
};
template <class V>
inline Arc<V> arc_of_root(Pair<V> t, V z) {
  const V w = z * z;
  // 1/6 in two parts.
  const V more = z * polynomial(w, 0.07499999999999932, 0.030381944430977196, 0.01735274456476081,
                                0.01154606244219418, 0.007961300876231573, -0.0021103623560325556,
                                -0.030328465581042244) +
                 (w * polynomial(w, 0.04464285714300871, 0.022372159745496587, 0.013965247555913416,
                                 0.009819966510007468, 0.00958769054422907, 0.02770584227276977,
                                 0.03418211973595665) +
                  0x1.5555555555555p-57);
  const V cube = t.high * z;
  return {t.high, cube * 0x1.5555555555555p-3, (t.low + 0.5 * (t.low * z)) + cube * more};
}
// arcsin(size) or, above 1/2, arcsin sqrt((1 - size)/2).
template <class V>
inline Arc<V> half_arc(V size, MaskOf<V> large) {
  const V half = 0.5 * (1 - size);
  const V z = large ? half : size * size;
  return arc_of_root(select<V>(large, root(Pair<V>{half, V()}), {size, V()}), z);
}
// quarters pi/2 + factor arc, for factors that are powers of 2.
template <class V>
inline V turned(V quarters, V factor, Arc<V> arc) {
  const Pair<V> sum = sum_with_larger(quarters * 0x1.921fb54442d18p+0, factor * arc.high);
  const V rest = factor * arc.low + (sum.low + quarters * 0x1.1a62633145c07p-54);
  return sum.high + (factor * arc.beyond + rest);
}
template <class V>
inline V lane_asin(V x) {
  const V size = lane_abs(x);
  const MaskOf<V> large = size > V() + 0.5;
  const V one = V() + 1;
  const V value = turned(large ? one : V(), large ? V() - 2 : one, half_arc(size, large));
  return with_sign_of(value, x);
}
// pi/2 - arcsin x, or with the arc of (1 - abs x)/2 twice that, or pi less twice that.
template <class V>
inline V lane_acos(V x) {
  const V size = lane_abs(x);
  const MaskOf<V> large = size > V() + 0.5;
  const MaskOf<V> left = x < V();
  const V one = V() + 1;
  const V quarters = large ? (left ? one + one : V()) : one;
  const V factor = large ? (left ? V() - 2 : one + one) : (left ? one : -one);
  return turned(quarters, factor, half_arc(size, large));
}
template <int W>
inline Pack<W> lane_atan(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_atan(x); }, a);
}
template <int W>
inline Pack<W> lane_asin(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_asin(x); }, a);
}
template <int W>
inline Pack<W> lane_acos(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_acos(x); }, a);
}
template <int W>
inline Pack<W> lane_atan2(const Pack<W>& a, const Pack<W>& b) {
  return lanewise<W>([](auto x, auto y) { return lane_atan2(x, y); }, a, b);
}
template <int W>
inline Pack<W> lane_atan2(const Pack<W>& a, double b) {
  return lane_atan2(a, Pack<W>(b));
}
template <int W>
inline Pack<W> lane_atan2(double a, const Pack<W>& b) {
  return lane_atan2(Pack<W>(a), b);
}
