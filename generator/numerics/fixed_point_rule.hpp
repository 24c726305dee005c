// When to stop an iteration that has no other end than rounding: where it stands still, or at
// stagnation with one second chance, that is when twice in a row no component has moved less than
// ever before.  A zero may be an accident and says nothing.  Every Cycle-th iteration is compared:
// 2 for a fixed point, where q hangs on p and p on q alone, so that even and odd iterations are two
// sequences, and one may be far ahead of the other; 1 for Newton's iteration.  The larger the last
// increment, the longer it must stand still: 64, 512, 4096 units of rounding after 2, 3, 4 times.
template <int Size, int Cycle>
struct FixedPointRule {
  Real least[Cycle][Size] = {};  // 0 before the first increment
  Real size = 0;                 // of the last increment
  int stuck = 0;

  void begin() {
    for (auto& cycle : least) {
      for (Real& smallest : cycle) smallest = 0;
    }
    stuck = 0;
  }
  // moved, length: of each component, its increment and what that was rounded with; scale: the sum
  // of what all were rounded with.
  Verdict operator()(const Real (&moved)[Size], const Real (&length)[Size], Real scale,
                     int iterations) {
    bool decreased = false;
    size = 0;
    for (int i = 0; i < Size; ++i) {
      Real& smallest = least[iterations % Cycle][i];
      const Real now = magnitude(moved[i]);
      // Among many components one always flickers: but not far below its rounding.
      const bool visible = now * 8 > epsilon * length[i];
      if (visible && (smallest <= 0 || now < smallest)) {
        decreased = true;
        smallest = now;
      }
      size += now;
    }
    if (!(size <= largest)) return Verdict::failed;
    if (size <= 0) return Verdict::done;
    const Real round_off = epsilon * scale;
    stuck = decreased ? 0 : stuck + 1;
    if (stuck >= 2 && size <= 64 * round_off) return Verdict::done;
    if (stuck >= 3 && size <= 512 * round_off) return Verdict::done;
    if (stuck >= 4 && size <= 4096 * round_off) return Verdict::done;
    // What still decreases then does so by a few hundredths at a time: much more is missing.
    return iterations < 500 ? Verdict::go_on : Verdict::failed;
  }
};
