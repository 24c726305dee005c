// A sum of many terms, in eight parts that do not wait for each other.
template <class Term>
inline Real sum_of(int count, const Term& term) {
  Real parts[8] = {};
  int j = 0;
  if constexpr (sizeof(Real) <= 8) {
    for (; j + 8 <= count; j += 8) {
#if defined __AVX__ && \
    !defined __clang__  // else g++ takes them apart, and adds one after the other
#pragma GCC unroll 1
#endif
      for (int k = 0; k < 8; ++k) parts[k] += term(j + k);
    }
  } else {
    for (; j + 8 <= count; j += 8) {
      for (int k = 0; k < 8; ++k) parts[k] += term(j + k);
    }
  }
  for (int k = 0; j + k < count; ++k) parts[k] += term(j + k);
  return ((parts[0] + parts[4]) + (parts[1] + parts[5])) +
         ((parts[2] + parts[6]) + (parts[3] + parts[7]));
}
// Of a known number of them: eight at once are not written where there are fewer, or g++ warns of
// elements beyond the last.
template <int Count, class Term>
inline Real sum_of(const Term& term) {
  if constexpr (Count >= 8) {
    return sum_of(Count, term);
  } else {
    Real parts[8] = {};
    for (int k = 0; k < Count; ++k) parts[k] = term(k);
    return ((parts[0] + parts[4]) + (parts[1] + parts[5])) +
           ((parts[2] + parts[6]) + (parts[3] + parts[7]));
  }
}
template <int Size>
inline Real lengths_of(const Real (&vector)[Size]) {
  return sum_of<Size>([&](int j) { return magnitude(vector[j]); });
}
template <int Size>
inline Real squares_of(const Real (&vector)[Size]) {
  return sum_of<Size>([&](int j) { return vector[j] * vector[j]; });
}
// Of their sum.
template <int Size>
inline Real squares_of(const Real (&vector)[Size], const Real (&other)[Size]) {
  return sum_of<Size>([&](int j) { return (vector[j] + other[j]) * (vector[j] + other[j]); });
}
