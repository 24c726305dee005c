// When to stop a fixed point in each lane that starts near its end: as the rule of one trajectory
// does (contraction_rule.hpp has the reasons).
template <int Cycle>
struct ContractionRule : FixedPointRule<2> {
  Real contraction = largest;  // of so many increments; where nothing is known
  Real past[Cycle] = {};       // increments before the last, the oldest first; 0: there was none
  Real round_off = 0;
  Real of_round = 1;
  int work = 0;
  bool checks = false;
  Mask near = false;  // is each unknown?
  Mask sure = false;  // was each before the last increment?
  Mask settled = false;

  // What the other solver's matrix costs, in evaluations of the equations; 0: there is no other.
  void begin(const Turn& turn, int matrix_work) {
    FixedPointRule<2>::begin(turn);
    size = 0;
    for (Real& each : past) each = 0;
    work = matrix_work;
    checks = turn.is_check();
    near = false;
    settled = false;
  }
  Mask operator()(const Distance& moved, int iterations) {
    for (int k = 1; k < Cycle; ++k) past[k - 1] = select(open, past[k], past[k - 1]);
    past[Cycle - 1] = select(open, size, past[Cycle - 1]);
    const Real& oldest = past[0];
    Judgement judgement = judge(moved, iterations);
    round_off = select(open, moved.round_off(), round_off);
    sure = (sure & !open) | (open & (near | (size <= 0)));
    near = moved.near();
    const Mask measured = oldest > 0;
    learn(open & !judgement.failed & measured & (size > 64 * round_off), size / oldest);
    judgement.failed = judgement.failed | is_slow();
    // When it is tried again, things may have changed.
    if (work > 0) contraction = select(open & judgement.failed, Real(largest), contraction);
    // Of an increment that is mostly rounding, what is missing from before.
    const Real expected = contraction * oldest;
    const Real missing = select(measured & (size <= round_off) & (expected < size), expected, size);
    const Mask settles = open & !judgement.failed & !Mask(checks) & is_lost(missing);
    settled = settled | settles;
    // So few increments say nothing of the contraction, and another may settle it; none at all, as
    // in a state of equilibrium, never will.
    const Mask grows = (of_two(Real(2)) * size > oldest) & (size > 8 * round_off) & Mask(work > 0);
    const Mask another = (contraction >= largest) | is_lost(next());
    const Mask goes_on =
        (size > 0) & Mask(iterations < 500) & ((measured & grows) | (another & !measured));
    judgement.done = settles | (judgement.done & !goes_on);
    return end(judgement);
  }
  // Is the last increment made?
  Mask moves() const { return settled | (contraction * of_two(Real(96)) <= 1); }
  // It may rise at once but falls slowly: one small increment may be luck.
  void learn(const Mask& lanes, const Real& seen) {
    const Real fourth = of_two(Real(4));
    const Mask takes =
        (contraction >= largest) | (seen > contraction) | (fourth * seen > contraction);
    contraction = select(lanes, select(takes, seen, contraction / fourth), contraction);
  }
  // Of rounds of Refinement.
  void learn_of_rounds(const Mask& lanes, int count, const Real& left, const Real& visible) {
    if (count == 1) of_round = select(lanes, left, of_round);
    if (count != Cycle) return;
    const Real twice = of_round * of_round;
    const Real hidden = select(twice < visible, twice, visible);
    learn(lanes, select(Mask(Cycle == 1) | (left > visible), left, hidden));
  }
  Mask rounds_asked() const { return Mask(Cycle == 2) & ((contraction >= largest) | Mask(checks)); }
  // Would an iteration of Newton's, which costs as much, come nearer by more?
  Mask is_slow() const {
    if (work == 0) return false;
    Real left = 1;
    for (int round = 0; round < work; ++round) left = left * contraction;
    const Real of_digits = Cycle == 1 ? left * left : left;
    return (contraction < largest) & ((2 * contraction > 1) | (of_digits * of_digits > epsilon));
  }
  Mask gives_up() {
    const Mask slow = is_slow();
    contraction = select(slow, Real(largest), contraction);
    return slow;
  }

 private:
  // What one increment does is done twice by two.
  static Real of_two(const Real& of_one) { return Cycle == 1 ? of_one : of_one * of_one; }
  Mask is_lost(const Real& missing) const {
    const Real of_next_but_one = Cycle == 1 ? contraction * contraction : contraction;
    return (contraction < 1) & (of_next_but_one * missing * 1048576 <= round_off);
  }
  // The next increment; of two, if the one before it is not known, as if it fell by a 64th.
  Real next() const {
    if (Cycle == 1) return contraction * size;
    return select(past[Cycle - 1] > 0, contraction * past[Cycle - 1], size / 64);
  }
};
