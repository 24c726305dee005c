// How far an iteration has moved: sums over the unknowns of their increments and of what these are
// rounded with, and whether each is close to its end.
struct Distance {
  // What is left below that is solved for by Refinement.
  static constexpr Real units = 64;
  Real size = 0;
  Real scale = 0;
  bool close = true;

  void add(Real moved, Real length) {
    size += moved;
    scale += length;
    close = close && moved <= units * epsilon * length;
  }
  // Arrays of them, rounded with what stands beside.
  void add(const Real* moved, const Real* value, const Real* beside, int count) {
    const Real all_moved = sum_of(count, [&](int j) { return magnitude(moved[j]); });
    const Real all_lengths =
        sum_of(count, [&](int j) { return magnitude(value[j]) + magnitude(beside[j]); });
    size += all_moved;
    scale += all_lengths;
    // Not each is close where all of them together are not.
    close = close && all_moved <= 2 * units * epsilon * all_lengths;
    if (!close) return;
    const Real far = sum_of(count, [&](int j) {
      const Real length = magnitude(value[j]) + magnitude(beside[j]);
      return magnitude(moved[j]) <= units * epsilon * length ? Real(0) : Real(1);
    });
    close = far < 1;
  }
};
// When to stop an iteration that has no other end than rounding: where all unknowns are close to
// it, or at stagnation, when twice in a row it has not moved less than ever before.  Every Cycle-th
// iteration is compared: 2 for a fixed point, where q hangs on p and p on q alone, so that even and
// odd iterations are two sequences, and one may be far ahead of the other; 1 for Newton's
// iteration. The larger the last increment, the longer it must stand still: 64, 512, 4096 units of
// rounding after 2, 3, 4 times.
template <int Cycle>
struct FixedPointRule {
  Real least[Cycle] = {};  // 0 before the first increment
  Real size = 0;           // of the last increment
  int stuck = 0;

  void begin() {
    for (Real& smallest : least) smallest = 0;
    stuck = 0;
  }
  Verdict operator()(const Distance& moved, int iterations) {
    size = moved.size;
    if (!(size <= largest)) return Verdict::failed;
    if (moved.close) return Verdict::done;
    Real& smallest = least[iterations % Cycle];
    const bool decreased = smallest <= 0 || size < smallest;
    if (decreased) smallest = size;
    stuck = decreased ? 0 : stuck + 1;
    const Real round_off = epsilon * moved.scale;
    if (stuck >= 2 && size <= 64 * round_off) return Verdict::done;
    if (stuck >= 3 && size <= 512 * round_off) return Verdict::done;
    if (stuck >= 4 && size <= 4096 * round_off) return Verdict::done;
    // What still decreases then does so by a few hundredths at a time: much more is missing.
    return iterations < 500 ? Verdict::go_on : Verdict::failed;
  }
};
