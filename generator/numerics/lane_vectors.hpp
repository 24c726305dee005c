// Numbers in lanes: vectors of GCC and Clang, or a number, which is a vector of one.  No operation
// that is used of them rounds otherwise than that of one number, so that the bits of a lane depend
// neither on how many there are nor on the instructions of the machine (contraction off).
template <int Lanes>
struct VectorOf {
  typedef double Numbers __attribute__((vector_size(8 * Lanes)));
  typedef unsigned long long Bits __attribute__((vector_size(8 * Lanes)));
};
template <>
struct VectorOf<1> {
  using Numbers = double;
  using Bits = unsigned long long;
};
template <class V>
using BitsOf = typename VectorOf<sizeof(V) / 8>::Bits;
template <class V>
using MaskOf = decltype(V() < V());

template <class V>
inline BitsOf<V> bits_of(V x) {
  BitsOf<V> bits;
  __builtin_memcpy(&bits, &x, sizeof(V));
  return bits;
}
template <class V>
inline V number_of(BitsOf<V> bits) {
  V x;
  __builtin_memcpy(&x, &bits, sizeof(V));
  return x;
}
inline constexpr unsigned long long sign_bit = 1ULL << 63;

template <class V>
inline V lane_abs(V x) {
  return number_of<V>(bits_of(x) & ~sign_bit);
}
// |x| with the sign of y.
template <class V>
inline V with_sign_of(V x, V y) {
  return number_of<V>((bits_of(x) & ~sign_bit) | (bits_of(y) & sign_bit));
}
template <class V>
inline V lane_sqrt(V x) {
  if constexpr (sizeof(V) == 8) {
    return __builtin_sqrt(x);
  } else {
    V root = x;
    for (int i = 0; i < int(sizeof(V) / 8); ++i) root[i] = __builtin_sqrt(x[i]);
    return root;
  }
}
inline bool is_set(bool mask, int) { return mask; }
template <class Mask>
inline bool is_set(Mask mask, int lane) {
  return mask[lane] != 0;
}
#ifdef __AVX512DQ__
template <class Mask>
inline int signs_of(Mask mask) {
  typedef long long Signs __attribute__((vector_size(64)));
  Signs signs;
  __builtin_memcpy(&signs, &mask, sizeof(Mask));
  return static_cast<unsigned char>(__builtin_ia32_cvtq2mask512(signs));
}
#endif
// By halves, where the machine has nothing better.
template <class Mask>
inline bool all(Mask mask) {
  if constexpr (sizeof(Mask) == 1) {
    return mask;
  } else if constexpr (sizeof(Mask) == 16) {
    return (mask[0] & mask[1]) != 0;
#ifdef __AVX512DQ__
  } else if constexpr (sizeof(Mask) == 64) {
    return signs_of(mask) == 255;
#endif
  } else {
    MaskOf<typename VectorOf<sizeof(Mask) / 16>::Numbers> half[2];
    __builtin_memcpy(half, &mask, sizeof(Mask));
    return all(half[0] & half[1]);
  }
}
template <class Mask>
inline bool any(Mask mask) {
  if constexpr (sizeof(Mask) == 1) {
    return mask;
  } else if constexpr (sizeof(Mask) == 16) {
    return (mask[0] | mask[1]) != 0;
#ifdef __AVX512DQ__
  } else if constexpr (sizeof(Mask) == 64) {
    return signs_of(mask) != 0;
#endif
  } else {
    MaskOf<typename VectorOf<sizeof(Mask) / 16>::Numbers> half[2];
    __builtin_memcpy(half, &mask, sizeof(Mask));
    return any(half[0] | half[1]);
  }
}
// The nearest integer where abs(x) < 2^51, and that integer in the last bits of what is added to
// it.
inline constexpr double integer_magic = 0x1.8p52;
template <class V>
inline V nearest_integer(V x) {
  return (x + integer_magic) - integer_magic;
}
// 2^n for integers -1023 < n < 1024.
template <class V>
inline V power_of_two(V n) {
  return number_of<V>(bits_of(n + (integer_magic + 1023)) << 52);
}
// x 2^n for integers abs(n) < 2000, rounded once if x is between 1/2 and 2.
template <class V>
inline V scaled(V x, V n) {
  const V half = nearest_integer(0.5 * n);
  return x * power_of_two(half) * power_of_two(n - half);
}
// c_0 + c_1 z + c_2 z^2 + ...
template <class V>
inline V polynomial(V z, double c0, double c1) {
  return c0 + z * c1;
}
template <class V, class... More>
inline V polynomial(V z, double c0, double c1, More... more) {
  return c0 + z * polynomial(z, c1, more...);
}
