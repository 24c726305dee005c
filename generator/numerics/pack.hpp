// W numbers in lanes, for any W that is a power of two: one vector, or two packs of half as many
// where the registers of the machine are shorter.
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
      this->all = x - typename VectorOf<W>::Numbers();  // which keeps -0
    } else {
      this->first = this->second = x;
    }
  }
  explicit Pack(const double (&x)[W]) { __builtin_memcpy(this, x, sizeof x); }
  // The numbers from x on.
  static Pack at(const double* x) {
    Pack pack;
    if constexpr (W <= register_lanes) {
      __builtin_memcpy(&pack, x, sizeof pack);
    } else {
      pack.first = Pack<W / 2>::at(x);
      pack.second = Pack<W / 2>::at(x + W / 2);
    }
    return pack;
  }
  static void put(double* x, const Pack& pack) {
    if constexpr (W <= register_lanes) {
      __builtin_memcpy(x, &pack, sizeof pack);
    } else {
      Pack<W / 2>::put(x, pack.first);
      Pack<W / 2>::put(x + W / 2, pack.second);
    }
  }
  static void add(double* x, const Pack& pack) { put(x, at(x) + pack); }
  void copy_to(double (&x)[W]) const { __builtin_memcpy(x, this, sizeof x); }
  double operator[](int lane) const {
    double x[W];
    copy_to(x);
    return x[lane];
  }
  void set(int lane, double value) {
    double x[W];
    copy_to(x);
    x[lane] = value;
    *this = Pack(x);
  }

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
  friend LaneMask<W> operator<=(const Pack& a, const Pack& b) {
    return compared([](auto x, auto y) { return x <= y; }, a, b);
  }
  friend LaneMask<W> operator<(const Pack& a, const Pack& b) {
    return compared([](auto x, auto y) { return x < y; }, a, b);
  }
  friend LaneMask<W> operator>(const Pack& a, const Pack& b) { return b < a; }
  friend LaneMask<W> operator>=(const Pack& a, const Pack& b) { return b <= a; }
  friend LaneMask<W> operator==(const Pack& a, const Pack& b) {
    return compared([](auto x, auto y) { return x == y; }, a, b);
  }
  Pack& operator+=(const Pack& b) { return *this = *this + b; }
  Pack& operator-=(const Pack& b) { return *this = *this - b; }
};
template <int W, class Comparison>
inline LaneMask<W> compared(const Comparison& comparison, const Pack<W>& a, const Pack<W>& b) {
  LaneMask<W> result;
  if constexpr (W <= register_lanes) {
    result.all = comparison(a.all, b.all);
  } else {
    result.first = compared(comparison, a.first, b.first);
    result.second = compared(comparison, a.second, b.second);
  }
  return result;
}
template <int W>
constexpr int lanes_of(const Pack<W>&) {
  return W;
}
// a in the lanes of the mask, b in the others.
template <int W>
inline Pack<W> select(const LaneMask<W>& mask, const Pack<W>& a, const Pack<W>& b) {
  Pack<W> result;
  if constexpr (W <= register_lanes) {
    result.all = mask.all ? a.all : b.all;
  } else {
    result.first = select(mask.first, a.first, b.first);
    result.second = select(mask.second, a.second, b.second);
  }
  return result;
}
template <int W>
inline Pack<W> lane_abs(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_abs(x); }, a);
}
template <int W>
inline Pack<W> lane_sqrt(const Pack<W>& a) {
  return lanewise<W>([](auto x) { return lane_sqrt(x); }, a);
}
