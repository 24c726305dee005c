// When to stop Newton's iteration: at round-off.  Increments shrink as
//   next <= contraction * size^Power,
// Power = 2 with the exact matrix, 1 with an approximate one.  The contraction is measured, kept
// from step to step and checked at least every 32nd step.  The last increment still enters the
// solution, so an iteration may stop when the next one would be lost in rounding.  What is cut off
// is a bias where rounding is a random walk, and in the momenta it counts 1/h times: the factor
// 2^-20 keeps it below the sum of the rounding errors.
template <int Power>
struct NewtonRule {
  Real contraction = largest;
  int unchecked = 0;
  Real previous = 0;
  int grown = 0;

  static Real power(Real size) { return Power == 2 ? size * size : size; }
  void begin() {
    previous = 0;
    grown = 0;
  }
  // size, scale: sums over the unknowns, of their increments and of their values.
  Verdict operator()(Real size, Real scale, int iterations) {
    if (!(size <= largest)) return Verdict::failed;
    const Real round_off = epsilon * scale;
    if (previous > 0) {
      const Real seen = (size < round_off ? round_off : size) / power(previous);
      // It may rise at once but falls slowly: one small increment may be luck.
      const bool first = contraction >= largest;
      if (first || (size > 64 * round_off && seen > contraction)) {
        contraction = seen;
      } else if (seen < contraction) {
        contraction = 4 * seen < contraction ? contraction / 4 : seen;
      }
      unchecked = 0;
      // No progress twice in a row: this is round-off if it is small, else it may still recover.
      grown = size < previous ? 0 : grown + 1;
      if (grown >= 2 && size <= 4096 * round_off) return Verdict::done;
    } else {
      ++unchecked;
    }
    if (size <= round_off) return Verdict::done;
    if (unchecked < 32 && contraction * power(size) * 1048576 <= round_off) return Verdict::done;
    previous = size;
    return iterations < 60 ? Verdict::go_on : Verdict::failed;
  }
};
