// A yes or no in lanes, for any number of them that is a power of two: one vector, or two masks of
// half as many where the registers of the machine are shorter.
#if defined __AVX512F__
inline constexpr int register_lanes = 8;
#elif defined __AVX2__
inline constexpr int register_lanes = 4;
#else
inline constexpr int register_lanes = 2;
#endif
template <int W>
struct LaneMask;
template <int W, bool fits>
struct MaskContent {
  MaskOf<typename VectorOf<W>::Numbers> all;
};
template <int W>
struct MaskContent<W, false> {
  LaneMask<W / 2> first, second;
};
// A function of vectors of masks, lane by lane.
template <int W, class Function, class... Masks>
inline LaneMask<W> maskwise(const Function& function, const Masks&... masks) {
  LaneMask<W> result;
  if constexpr (W <= register_lanes) {
    result.all = function(masks.all...);
  } else {
    result.first = maskwise<W / 2>(function, masks.first...);
    result.second = maskwise<W / 2>(function, masks.second...);
  }
  return result;
}
template <int W>
struct LaneMask : MaskContent<W, (W <= register_lanes)> {
  LaneMask() = default;
  // The same in all lanes.
  LaneMask(bool yes) {
    if constexpr (W <= register_lanes) {
      const typename VectorOf<W>::Numbers zero = {};
      this->all = yes ? zero == zero : zero != zero;
    } else {
      this->first = this->second = yes;
    }
  }
  bool operator[](int lane) const {
    if constexpr (W <= register_lanes) {
      return is_set(this->all, lane);
    } else {
      return lane < W / 2 ? this->first[lane] : this->second[lane - W / 2];
    }
  }
  friend LaneMask operator&(const LaneMask& a, const LaneMask& b) {
    return maskwise<W>([](auto x, auto y) { return x & y; }, a, b);
  }
  friend LaneMask operator|(const LaneMask& a, const LaneMask& b) {
    return maskwise<W>([](auto x, auto y) { return x | y; }, a, b);
  }
  friend LaneMask operator!(const LaneMask& a) {
    return maskwise<W>([](auto x) { return x == 0; }, a);
  }
};
template <int W>
inline bool all(const LaneMask<W>& mask) {
  if constexpr (W <= register_lanes) {
    return all(mask.all);
  } else {
    return all(mask.first & mask.second);
  }
}
template <int W>
inline bool any(const LaneMask<W>& mask) {
  if constexpr (W <= register_lanes) {
    return any(mask.all);
  } else {
    return any(mask.first | mask.second);
  }
}
