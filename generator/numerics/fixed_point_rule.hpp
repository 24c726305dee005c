// How far an iteration has moved: sums over the unknowns of their increments, of what these are
// rounded with, and of the increments of those that are not near their end.
struct Distance {
  // Over so many units of rounding, and from there `amplifier` times as far, what is not linear is
  // far below them, and Refinement goes on: in double 2^17 * 2^28 * 2^-52 of a unit, and of what is
  // left after a contraction less than that. In float 16384 units are 2e-3 of a number; 4 give
  // 2^7 * 2^4 * 2^-23.
  Real units = epsilon < Real(1e-10) ? 16384 : 4;
  // In loops a round of Refinement costs more than an iteration: there it is left less.  Nor may
  // one of many unknowns, whose sum is near, be left some thousand units: between walls exp(40 (q -
  // 1)) the way that is looked over is not straight then, and its energy fell by 8e-4 roundings a
  // step.
  void narrow() {
    if (units > 64) units = 64;
  }
  // What is less than this of the whole, far below what rounding takes from it, is not waited for:
  // ahead of a wave every unknown is so much smaller than the one before it that an iteration
  // brings one after the other to its end.
  static constexpr Real lost = epsilon * epsilon * epsilon;
  // What is rounded like this: a unit of rounding of smaller numbers may be lost below the smallest
  // number there is, and how far they are from their end cannot be told by it.
  static constexpr Real tiny = 1 / largest;
  Real size = 0;
  Real scale = 0;
  Real far = 0;

  Real far_of(Real moved, Real length) const {
    return moved <= units * epsilon * (length + tiny) ? Real(0) : moved;
  }
  bool near() const { return far <= lost * scale; }
  Real round_off() const { return epsilon * (scale + 64 * tiny); }

  void add(Real moved, Real length) {
    size += moved;
    scale += length;
    far += far_of(moved, length);
  }
  // Arrays of them, rounded with what stands beside.
  void add(const Real* moved, const Real* value, const Real* beside, int count) {
    const Real all_moved = sum_of(count, [&](int j) { return magnitude(moved[j]); });
    const Real all_lengths =
        sum_of(count, [&](int j) { return magnitude(value[j]) + magnitude(beside[j]); });
    size += all_moved;
    scale += all_lengths;
    // Not each is near where all of them together are not.
    Real all_far = far_of(all_moved, 2 * all_lengths);
    if (all_far <= 0) {
      all_far = sum_of(count, [&](int j) {
        return far_of(magnitude(moved[j]), magnitude(value[j]) + magnitude(beside[j]));
      });
    }
    far += all_far;
  }
};
// When to stop an iteration that has no other end than rounding: where all unknowns are near it and
// the next increment is lost in it, or at stagnation, when twice in a row it has not moved less
// than ever before.  Every Cycle-th iteration is compared: 2 for a fixed point, where q hangs on p
// and p on q alone, so that even and odd iterations are two sequences, and one may be far ahead of
// the other; 1 for Newton's iteration. The larger the last increment, the longer it must stand
// still: 64, 512, 4096 units of rounding after 2, 3, 4 times.
//
// Note [what is lost in rounding]
// Refinement begins with what rounding leaves of the unknowns, and takes as many rounds for that as
// for some 8 units more.  So the next increment may be as large: it is the last one times the
// contraction, which this and the one before it show.  A first increment is judged by the
// contraction of the step before, four times over, but for every 32nd.  (With 64 units, pairs whose
// bond is a 1e6th of their coordinates were off by 51 roundings: over such a way, amplified, their
// force is not linear.)
//
// What grows a thousandfold after four increments, in which momenta and coordinates of different
// units may have found each other, does not come back: it began with a prediction that led astray,
// and would go on to numbers whose sines take ten times as long.
template <int Cycle>
struct FixedPointRule {
  Real least[Cycle] = {};  // 0 before the first increment
  Real size = 0;           // of the last increment
  Real before = 0;         // and of the one before it in this step, if there is one
  Real contraction = 1;    // of these two, in the step before
  int unchecked = 32;      // steps since it was measured
  int stuck = 0;
  Real begun = 0;  // the largest of the first four increments

  void begin() {
    begun = 0;
    for (Real& smallest : least) smallest = 0;
    stuck = 0;
    if (before > 0) {
      contraction = size < before ? size / before : Real(1);
      unchecked = 0;
    }
    size = 0;
  }
  Verdict operator()(const Distance& moved, int iterations) {
    const Verdict verdict = judge(moved, iterations);
    return verdict == Verdict::go_on && comes_near(moved) ? Verdict::done : verdict;
  }
  // Of an iteration that has been judged: see Note [what is lost in rounding].
  bool comes_near(const Distance& moved) {
    const Real most = 8 * moved.round_off();
    if (before > 0) return size * size <= most * before && size < before && moved.near();
    return ++unchecked <= 32 && 4 * contraction * size <= most && moved.near();
  }
  // By the last increment alone.
  Verdict judge(const Distance& moved, int iterations) {
    before = size;
    size = moved.size;
    if (!(size <= largest)) return Verdict::failed;
    if (iterations <= 4) {
      if (size > begun) begun = size;
    } else if (size > 1024 * begun) {
      return Verdict::failed;
    }
    const Real round_off = moved.round_off();
    if (moved.near() && size <= 64 * round_off) return Verdict::done;
    Real& smallest = least[iterations % Cycle];
    const bool decreased = smallest <= 0 || size < smallest;
    if (decreased) smallest = size;
    stuck = decreased ? 0 : stuck + 1;
    if (stuck >= 2 && size <= 64 * round_off) return Verdict::done;
    if (stuck >= 3 && size <= 512 * round_off) return Verdict::done;
    if (stuck >= 4 && size <= 4096 * round_off) return Verdict::done;
    // What still decreases then does so by a few hundredths at a time: much more is missing.
    return iterations < 500 ? Verdict::go_on : Verdict::failed;
  }
};
