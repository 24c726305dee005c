// W numbers in lanes, for any W that is a power of two: one vector, or two packs of half as many
// where the registers of the machine are shorter.
#if defined __AVX512F__
inline constexpr int register_lanes = 8;
#elif defined __AVX2__
inline constexpr int register_lanes = 4;
#else
inline constexpr int register_lanes = 2;
#endif
template <int W>
struct Pack;
template <int W, bool fits>
struct PackContent {
  typename VectorOf<W>::Numbers all;
};
template <int W>
struct PackContent<W, false> {
  Pack<W / 2> first, second;
};
// A function of vectors, lane by lane.
template <int W, class Function, class... Packs>
inline Pack<W> lanewise(const Function& function, const Packs&... packs) {
  Pack<W> result;
  if constexpr (W <= register_lanes) {
    result.all = function(packs.all...);
  } else {
    result.first = lanewise<W / 2>(function, packs.first...);
    result.second = lanewise<W / 2>(function, packs.second...);
  }
  return result;
}
template <int W>
struct Pack : PackContent<W, (W <= register_lanes)> {
  Pack() = default;
  // The same number in all lanes.
  Pack(double x) {
    if constexpr (W <= register_lanes) {
      this->all = typename VectorOf<W>::Numbers() + x;
    } else {
      this->first = this->second = x;
    }
  }
  explicit Pack(const double (&x)[W]) { __builtin_memcpy(this, x, sizeof x); }
  void copy_to(double (&x)[W]) const { __builtin_memcpy(x, this, sizeof x); }

  friend Pack operator+(const Pack& a, const Pack& b) {
    return lanewise<W>([](auto x, auto y) { return x + y; }, a, b);
  }
  friend Pack operator-(const Pack& a, const Pack& b) {
    return lanewise<W>([](auto x, auto y) { return x - y; }, a, b);
  }
  friend Pack operator*(const Pack& a, const Pack& b) {
    return lanewise<W>([](auto x, auto y) { return x * y; }, a, b);
  }
  friend Pack operator/(const Pack& a, const Pack& b) {
    return lanewise<W>([](auto x, auto y) { return x / y; }, a, b);
  }
  friend Pack operator-(const Pack& a) {
    return lanewise<W>([](auto x) { return -x; }, a);
  }
  Pack& operator+=(const Pack& b) { return *this = *this + b; }
  Pack& operator-=(const Pack& b) { return *this = *this - b; }
};
template <int W>
inline Pack<W> lane_abs(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_abs(x); }, a);
}
template <int W>
inline Pack<W> lane_sqrt(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_sqrt(x); }, a);
}
