// x = n pi/2 + remainder, remainder between -pi/4 and pi/4.  pi/2 is taken in parts of 33, 33 and
// 53 bits, whose products with n < 2^20 are exact but for the last one: relative to x what is left
// out is 2^-103.
//
// Note [where the remainder is small or x is large]
// Lanes where the remainder is below 2^-30 x, or x above 2^20, are done one by one, by the 192 bits
// of 2/pi that matter: m 2^e 2/pi modulo 4, for the integer m of 53 bits, has no use for bits of
// 2/pi whose product with 2^e is a multiple of 4 (Payne and Hanek).  No double is nearer to a
// multiple of pi/2 than 2^-61: 70 bits of the remainder are right.
//
// Note [the rare lanes are a function]
// What is left is short enough for a compiler to write it out where it is called.  A record of two
// vectors that comes back from a function is in memory, and is read there in one piece that was
// stored in two, for which processors wait.
template <class V>
struct Reduced {
  BitsOf<V> quadrant;  // n modulo 4 in the last two bits
  Pair<V> remainder;
};
// Of x between 1/2 and infinity.
inline Reduced<double> reduced_exactly(double x) {
  // 2/pi, behind 64 zeros.
  constexpr unsigned long long inverse[] = {0,
                                            0xa2f9836e4e441529,
                                            0xfc2757d1f534ddc0,
                                            0xdb6295993c439041,
                                            0xfe5163abdebbc561,
                                            0xb7246e3a424dd2e0,
                                            0x06492eea09d1921c,
                                            0xfe1deb1cb129a73e,
                                            0xe88235f52ebb4484,
                                            0xe99c7026b45f7e41,
                                            0x3991d639835339f4,
                                            0x9c845f8bbdf9283b,
                                            0x1ff897ffde05980f,
                                            0xef2f118b5a0a6d1f,
                                            0x6d367ecf27cb09b7,
                                            0x4f463f669e5fea2d,
                                            0x7527bac7ebe5f17b,
                                            0x3d0739f78a5292ea,
                                            0x6bfb5fb11f8d5d08,
                                            0x56033046fc7b6bab,
                                            0};
  using Word = unsigned long long;
  __extension__ typedef unsigned __int128 Wide;
  const Word bits = bits_of(x);
  const int exponent = int(bits >> 52) - 1075;
  const Word integer = (bits & (~0ULL >> 12)) | 1ULL << 52;
  const int first = exponent + 62;  // bit of the table
  Word window[3];
  for (int i = 0; i < 3; ++i) {
    const Word* word = inverse + first / 64 + i;
    const int shift = first % 64;
    window[i] = shift == 0 ? word[0] : word[0] << shift | word[1] >> (64 - shift);
  }
  const Wide lowest = Wide(integer) * window[2];
  const Wide middle = Wide(integer) * window[1] + Word(lowest >> 64);
  const Word top = integer * window[0] + Word(middle >> 64);
  Word quadrant = top >> 62;
  // The fraction: 126 bits of it, 64 below.
  Wide fraction =
      Wide(top << 2 | Word(middle) >> 62) << 64 | (Word(middle) << 2 | Word(lowest) >> 62);
  Word below = Word(lowest) << 2;
  const bool upper = fraction >> 127 != 0;
  if (upper) {
    ++quadrant;
    fraction = ~fraction;
    below = ~below;
  }
  double unit = upper ? -1 : 1;
  while (fraction >> 127 == 0) {
    fraction = fraction << 1 | below >> 63;
    below <<= 1;
    unit *= 0.5;
  }
  const double high = unit * double(Word(fraction >> 75)) * 0x1p-53;
  const double low = unit * double(Word(fraction >> 22) & (~0ULL >> 11)) * 0x1p-106;
  const Pair<double> angle = exact_product(high, 0x1.921fb54442d18p+0);
  return {quadrant, sum_with_larger(angle.high, angle.low + (high * 0x1.1a62633145c07p-54 +
                                                             low * 0x1.921fb54442d18p+0))};
}
template <class V>
inline void reduce_lane(const V& x, Reduced<V>& reduced, int lane) {
  if constexpr (sizeof(V) == 8) {
    reduced = reduced_exactly(x);
  } else {
    const Reduced<double> one = reduced_exactly(x[lane]);
    reduced.quadrant[lane] = one.quadrant;
    reduced.remainder.high[lane] = one.remainder.high;
    reduced.remainder.low[lane] = one.remainder.low;
  }
}
// The lanes that are not sure.
template <class V>
__attribute__((noinline, cold)) void reduce_lanes(const V& x, const MaskOf<V>& sure,
                                                  Reduced<V>& result) {
  const V none = x - x;
  const MaskOf<V> finite = none == V();
  result.remainder.high += none;
  for (int i = 0; i < int(sizeof(V) / 8); ++i) {
    if (is_set(finite, i) && !is_set(sure, i)) reduce_lane(x, result, i);
  }
}
// Of x >= 0; of infinities and NaN it is NaN.
template <class V>
inline Reduced<V> reduced(V x) {
  const V shifted = x * 0x1.45f306dc9c883p-1 + integer_magic;
  const V n = shifted - integer_magic;
  const Pair<V> most = exact_sum(x - n * 0x1.921fb54400000p+0, -(n * 0x1.0b4611a600000p-34));
  Reduced<V> result = {bits_of(shifted),
                       sum_with_larger(most.high, most.low - n * 0x1.3198a2e037073p-69)};
  const V bound = x > V() + 0x1p20 ? V() + __builtin_nan("") : x * 0x1p-30;
  const MaskOf<V> sure = lane_abs(result.remainder.high) >= bound;
  if (__builtin_expect(!all(sure), 0)) reduce_lanes(x, sure, result);
  return result;
}
template <class V>
struct SineAndCosine {
  Pair<V> sine, cosine;
};
// Of a remainder.
template <class V>
inline SineAndCosine<V> sine_and_cosine(Pair<V> x) {
  const V z = x.high * x.high;
  const V w = z * z;
  const V more =
      z * polynomial(w, 0.00833333333333333, 2.755731921711006e-06, 1.6058441854541943e-10) +
      (w * polynomial(w, -0.0001984126984126165, -2.5052105576260643e-08, -7.582052672213754e-13) -
       0x1.5555555555555p-57);
  const V half = 0.5 * z;
  const V most = 1 - half;
  const V q =
      polynomial(w, 0.041666666666666595, 2.4801587289041504e-05, 2.087570669777651e-09) +
      z * polynomial(w, -0.001388888888887339, -2.755731422829501e-07, -1.1358798905706606e-11);
  const V cube = x.high * z;
  const V third = cube * -0x1.5555555555555p-3;  // -1/6, its rest is in `more`
  const V fourth = w * q;
  const V rest = x.low * (most + fourth) + cube * more;
  return {{x.high, third + rest},
          {most, ((1 - most) - half) + (fourth - (x.high + third) * x.low)}};
}
template <class V>
inline MaskOf<V> is_odd(BitsOf<V> quadrant) {
  return (quadrant & 1) != 0;
}
template <class V>
struct Circle {
  V sine, cosine;
};
// sin x and cos x.
template <class V>
__attribute__((const)) inline Circle<V> circle(V x) {
  const Reduced<V> at = reduced(lane_abs(x));
  const SineAndCosine<V> values = sine_and_cosine(at.remainder);
  const V sine = values.sine.high + values.sine.low;
  const V cosine = values.cosine.high + values.cosine.low;
  const MaskOf<V> odd = is_odd<V>(at.quadrant);
  const BitsOf<V> sign_of_sine = ((at.quadrant & 2) << 62) ^ (bits_of(x) & sign_bit);
  const BitsOf<V> sign_of_cosine = ((at.quadrant + 1) & 2) << 62;
  return {number_of<V>(bits_of(odd ? cosine : sine) ^ sign_of_sine),
          number_of<V>(bits_of(odd ? sine : cosine) ^ sign_of_cosine)};
}
template <class V>
inline V lane_sin(V x) {
  return circle(x).sine;
}
template <class V>
inline V lane_cos(V x) {
  return circle(x).cosine;
}
template <class V>
inline V lane_tan(V x) {
  const Reduced<V> at = reduced(lane_abs(x));
  const SineAndCosine<V> values = sine_and_cosine(at.remainder);
  const MaskOf<V> odd = is_odd<V>(at.quadrant);
  const Pair<V> sine = normal(values.sine);
  const V lost = exact_product(at.remainder.high, at.remainder.high).low;  // of its square
  const Pair<V> cosine = normal(Pair<V>{values.cosine.high, values.cosine.low - 0.5 * lost});
  const Pair<V> ratio = quotient(select<V>(odd, cosine, sine), select<V>(odd, sine, cosine));
  const BitsOf<V> sign = ((at.quadrant & 1) << 63) ^ (bits_of(x) & sign_bit);
  return number_of<V>(bits_of(ratio.high + ratio.low) ^ sign);
}
template <int W>
inline Pack<W> lane_sin(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_sin(x); }, a);
}
template <int W>
inline Pack<W> lane_cos(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_cos(x); }, a);
}
template <int W>
inline Pack<W> lane_tan(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_tan(x); }, a);
}
