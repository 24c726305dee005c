// When to stop solving linear equations for what they lack, which is known far below rounding.
//
// Note [what a solve leaves]
// The rounding errors of an increment are a part of it, the condition of the matrix times epsilon:
//   next <= contraction * size,
// as long as what is next is not the rounding of the unknowns themselves.  The contraction is
// measured, kept from step to step and checked at least every 32nd step, for an increment may meet
// a part of the matrix that those before have not.  What is left of the last one is a bias, of the
// sum of all unknowns and of each: the factors keep it below their rounding errors.
struct LinearRule {
  Real contraction = largest;  // where nothing is known
  Real previous = 0;
  int unchecked = 0;

  void begin() { previous = 0; }
  // An increment as a part of what its unknown is rounded with; nothing at the smallest numbers.
  static Real relative(Real moved, Real length) {
    return moved > 64 * epsilon / largest ? moved / length : Real(0);
  }
  // size, scale: sums over the unknowns of their increments and of their values; uneven: of the
  // increments as parts of their unknowns.
  Verdict operator()(Real size, Real scale, int iterations, Real uneven) {
    if (!(size <= largest)) return Verdict::failed;
    const Real round_off = epsilon * scale;
    if (previous > 0) {
      learn((size < round_off ? round_off : size) / previous, size > 64 * round_off);
    } else {
      ++unchecked;
    }
    previous = size;
    if (size <= round_off) return Verdict::done;
    const bool lost =
        contraction * size * 1048576 <= round_off && contraction * uneven * 16 <= epsilon;
    if (lost && unchecked < 32) return Verdict::done;
    return iterations < 60 ? Verdict::go_on : Verdict::failed;
  }
  // It may rise at once but falls slowly, and by what is mostly rounding it does not rise.
  void learn(Real seen, bool is_seen) {
    if (contraction >= largest || (is_seen && seen > contraction)) {
      contraction = seen;
    } else if (seen < contraction) {
      contraction = 4 * seen < contraction ? contraction / 4 : seen;
    }
    unchecked = 0;
  }
};
