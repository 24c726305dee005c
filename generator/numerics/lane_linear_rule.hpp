// When to stop solving linear equations in each lane: as the rule of one trajectory does
// (linear_rule.hpp has the reasons).  So that lanes stay in step the contraction is checked where
// the number of the step is a multiple of 32, in all of them.
struct LinearRule : Iteration {
  Real contraction = largest;
  Real previous = 0;
  bool checks = false;

  void begin(const Turn& turn) {
    Iteration::begin(turn);
    checks = turn.is_check();
  }
  // What an increment is of what its unknown is rounded with.
  static Real relative(const Real& moved, const Real& length) {
    return select(moved > 64 * epsilon / largest, moved / length, Real(0));
  }
  // The numbers are those that the rule of one trajectory is given.  Gives the lanes that move.
  Mask operator()(const Real& size, const Real& scale, int iterations, const Real& uneven) {
    taken = select(open, Real(iterations), taken);
    end_with(open & !(size <= largest), size);
    const Real round_off = epsilon * scale;
    if (iterations > 1) learn(size, round_off);
    const Mask lost = (contraction * size * 1048576 <= round_off) &
                      (contraction * uneven * 16 <= epsilon) & Mask(iterations > 1 || !checks);
    previous = select(open, size, previous);
    open = open & !((size <= round_off) | lost);
    if (iterations >= 60) end_with(open, size);
    return open;
  }
  // It may rise at once but falls slowly, and by what is mostly rounding it does not rise.
  void learn(const Real& size, const Real& round_off) {
    const Real seen = select(size < round_off, round_off, size) / previous;
    const Mask rises = (contraction >= largest) | ((size > 64 * round_off) & (seen > contraction));
    const Real lower = select(4 * seen < contraction, contraction / 4, seen);
    const Mask falls = (!rises) & (seen < contraction);
    contraction = select(open & rises, seen, select(open & falls, lower, contraction));
  }
};
