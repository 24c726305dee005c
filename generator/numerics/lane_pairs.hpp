// Numbers of twice the length: high + low, low of the size of the rounding of high or of a small
// correction.
template <class V>
struct Pair {
  V high, low;
};
// a + b, for abs(a) >= abs(b) or a = 0 (Dekker).
template <class V>
inline Pair<V> sum_with_larger(V a, V b) {
  const V sum = a + b;
  return {sum, b - (sum - a)};
}
template <class V>
inline Pair<V> exact_sum(V a, V b) {
  const V sum = a + b;
  const V part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}
// a b, but for 2^-76 of it (Dekker; the factors are cut between their bits, not rounded).
template <class V>
inline Pair<V> exact_product(V a, V b) {
  constexpr unsigned long long upper = ~0ULL << 27;
  const V product = a * b;
  const V a_high = number_of<V>(bits_of(a) & upper);
  const V b_high = number_of<V>(bits_of(b) & upper);
  const V a_low = a - a_high;
  const V b_low = b - b_high;
  const V mixed = ((a_high * b_high - product) + a_high * b_low) + a_low * b_high;
  return {product, mixed + a_low * b_low};
}
// With low of the size of the rounding of high.
template <class V>
inline Pair<V> normal(Pair<V> a) {
  return sum_with_larger(a.high, a.low);
}
// Of normal pairs.
template <class V>
inline Pair<V> quotient(Pair<V> a, Pair<V> b) {
  const V ratio = a.high / b.high;
  const Pair<V> back = exact_product(ratio, b.high);
  return {ratio, (((a.high - back.high) - back.low) + (a.low - ratio * b.low)) / b.high};
}
// sqrt a; of 0 it is 0.
template <class V>
inline Pair<V> root(Pair<V> a) {
  const V high = lane_sqrt(a.high);
  const Pair<V> square = exact_product(high, high);
  const V rest = ((a.high - square.high) - square.low) + a.low;
  return {high, rest / (2 * high + 0x1p-1000)};
}
template <class V>
inline Pair<V> select(MaskOf<V> mask, Pair<V> a, Pair<V> b) {
  return {mask ? a.high : b.high, mask ? a.low : b.low};
}
