// When to stop a fixed point in each lane that starts near its end: as the rule of one trajectory
// does (contraction_rule.hpp has the reasons).
struct ContractionRule : FixedPointRule<2> {
  Real contraction = largest;  // where nothing is known
  Real round_off = 0;
  int work = 0;
  bool checks = false;
  Mask settled = false;

  // What the other solver's matrix costs, in evaluations of the equations; 0: there is no other.
  void begin(const Turn& turn, int matrix_work) {
    FixedPointRule<2>::begin(turn);
    size = 0;
    work = matrix_work;
    checks = turn.is_check();
    settled = false;
  }
  Mask operator()(const Distance& moved, int iterations) {
    Judgement judgement = judge(moved, iterations);
    round_off = select(open, moved.round_off(), round_off);
    const Mask second = before > 0;
    learn(open & !judgement.failed & second & (size > 64 * round_off), size / before);
    judgement.failed = judgement.failed | is_slow();
    // When it is tried again, things may have changed.
    if (work > 0) contraction = select(open & judgement.failed, Real(largest), contraction);
    // Of an increment that is mostly rounding, what is missing from before.
    const Real expected = contraction * before;
    const Real missing = select(second & (size <= round_off) & (expected < size), expected, size);
    const Mask settles = open & !judgement.failed & !Mask(checks) & is_lost(missing);
    settled = settled | settles;
    // One increment alone says nothing of the contraction, and another may settle it; none at all,
    // as in a state of equilibrium, never will.
    const Mask grows = (2 * size > before) & (size > 8 * round_off) & Mask(work > 0);
    const Mask alone = (contraction >= largest) | is_lost(contraction * size);
    const Mask goes_on =
        (size > 0) & Mask(iterations < 500) & ((second & grows) | (alone & !second));
    judgement.done = settles | (judgement.done & !goes_on);
    return end(judgement);
  }
  // Is the last increment made?
  Mask moves() const { return settled | (contraction * 96 <= 1); }
  // It may rise at once but falls slowly: one small increment may be luck.
  void learn(const Mask& lanes, const Real& seen) {
    const Mask takes = (contraction >= largest) | (seen > contraction) | (4 * seen > contraction);
    contraction = select(lanes, select(takes, seen, contraction / 4), contraction);
  }
  // Would so many rounds of Refinement cost more than the matrix?
  Mask is_slow() const {
    if (work == 0) return false;
    Real left = 1;
    for (int round = 0; round < work; ++round) left = left * contraction;
    return (contraction < largest) & ((2 * contraction > 1) | (left * 8192 > 1));
  }

 private:
  Mask is_lost(const Real& missing) const {
    return (contraction < 1) & (contraction * contraction * missing * 1048576 <= round_off);
  }
};
