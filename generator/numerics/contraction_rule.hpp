// When to stop a fixed point that starts near its end: where what is still missing is lost in
// rounding, as far as the contraction is known; else FixedPointRule and Refinement have the word.
//
// Note [what an increment leaves]
// An increment of this size leaves the unknowns contraction * size from the solution, and the
// slopes taken there, which are all that a step keeps, another factor of the contraction.  That is
// a bias where rounding is a random walk, and in the momenta it counts 1/h times: the factor 2^-20
// keeps it below the sum of the rounding errors.  The slopes are then taken without Refinement.
//
// The contraction is that of two increments well above rounding, or what Refinement finds, at least
// in every 32nd step.  Whatever it was, what the equations lack where the slopes are taken is
// looked at in every step: if it is not lost in the rounding of the unknowns, Refinement goes on.
//
// Note [who has chosen the point]
// The image of the last iterate is near a point that the rounded map takes to itself, and which one
// that is its rounding has chosen, as far as it is seen through the contraction: 13 bodies lost
// 3e-4 roundings a step by a slow one, a linear ring of 30 2e-4 by one of 1/36, 9e-5 by 1/80, and
// nothing by 1/142.  Refinement begins at the iterate itself, down to 1/96, where what is
// seen, in proportion to the contraction, is below the 1e-4 that a step may be off in the mean.
//
// Note [what is far from its end]
// Of many unknowns most may hardly contract what one of them does at a wall, and what is told of
// all together is not true of that one.  Of 30 with two between walls exp(40 (q - 1)) these were
// thousands of units from their end and ended with the first increment: their energies were off by
// 6e-2 of a rounding more in every step.  Where each unknown was near before the last increment
// that is sure to be little.  Else Refinement looks at what follows the increment of each: what the
// equations lack behind it, less what rounding took from it, which is known without an error.  No
// more than a 2^-14th of the rounding of its momentum, of which its way is 1/h, may follow that in
// the same ratio.  (Asked of sums it was 8e-2 of a rounding beside others that are louder.)
//
// Note [of one or of two]
// Where coordinates move momenta and these the coordinates, two increments are in a ratio to each
// other that says how differently both are missing, and the next two are in another: both ratios
// together are the contraction of two (Cycle 2).  The next increment but one is that times the last
// one, in either case.
template <int Cycle>
struct ContractionRule {
  FixedPointRule<2> rule;
  Real contraction = largest;  // of so many increments; where nothing is known
  Real size = 0;               // of the last increment
  Real past[Cycle] = {};       // and of those before it, the oldest first; 0: there was none
  Real round_off = 0;
  Real of_round = 1;
  int work = 0;
  int unchecked = 0;
  bool near = false;  // is each unknown?
  bool sure = false;  // was each before the last increment?
  bool settled = false;

  // What the other solver's matrix costs, in evaluations of the equations; 0: there is no other.
  void begin(int matrix_work) {
    rule.begin();
    size = 0;
    for (Real& each : past) each = 0;
    work = matrix_work;
    near = false;
    settled = false;
  }
  Verdict operator()(const Distance& moved, int iterations) {
    for (int k = 1; k < Cycle; ++k) past[k - 1] = past[k];
    past[Cycle - 1] = size;
    const Real before = past[0];
    Verdict verdict = rule.judge(moved, iterations);
    size = rule.size;
    round_off = moved.round_off();
    sure = near || size <= 0;
    near = moved.near();
    if (verdict == Verdict::failed) return give_up();
    if (before > 0 && size > 64 * round_off) learn(size / before);
    if (is_slow()) return give_up();
    // Of an increment that is mostly rounding, what is missing from before.
    Real missing = size;
    if (before > 0 && size <= round_off && contraction * before < size) {
      missing = contraction * before;
    }
    settled = unchecked < 32 && is_lost(missing);
    if (settled) return Verdict::done;
    // So few increments say nothing of the contraction, and another may settle it; none at all,
    // as in a state of equilibrium, never will.
    const bool grows = before > 0 && of_two(2) * size > before && size > 8 * round_off;
    const bool goes_on = before > 0 ? grows && work > 0 : contraction >= largest || is_lost(next());
    const bool may_go_on = size > 0 && iterations < 500;
    return verdict == Verdict::done && goes_on && may_go_on ? Verdict::go_on : verdict;
  }
  // Is the last increment made?  See Note [who has chosen the point].
  bool moves() const { return settled || contraction * of_two(96) <= 1; }
  // It may rise at once but falls slowly: one small increment may be luck.
  void learn(Real seen) {
    const bool first = contraction >= largest;
    if (first || seen > contraction || of_two(4) * seen > contraction) {
      contraction = seen;
    } else {
      contraction /= of_two(4);
    }
    unchecked = 0;
  }
  // Of rounds of Refinement: what so many behind the first one left of it.  Of two that is seen as
  // far as a difference over so long a way tells; where it is less, it is what one did, twice.
  void learn_of_rounds(int count, Real left, Real visible) {
    if (count == 1) of_round = left;
    if (count != Cycle) return;
    if (Cycle == 1 || left > visible) return learn(left);
    const Real twice = of_round * of_round;
    learn(twice < visible ? twice : visible);
  }
  // Rounds that are asked for, where otherwise nothing would be known.
  int rounds_asked() const {
    return Cycle == 2 && (contraction >= largest || unchecked >= 32) ? 2 : 0;
  }
  // Would an iteration of Newton's, which costs as much as so many increments, come nearer by more
  // than these?  By a fourth of all digits, as two to three of them come from a prediction to the
  // solution.
  bool is_slow() const {
    if (work == 0 || contraction >= largest) return false;
    Real left = 1;
    for (int round = 0; round < work; ++round) left *= contraction;
    const Real of_digits = Cycle == 1 ? left * left : left;
    return 2 * contraction > 1 || of_digits * of_digits > epsilon;
  }
  // Where it is: when it is tried again, things may have changed.
  bool gives_up() {
    const bool slow = is_slow();
    if (slow) contraction = largest;
    return slow;
  }

 private:
  // What one increment does is done twice by two.
  static constexpr Real of_two(Real of_one) { return Cycle == 1 ? of_one : of_one * of_one; }
  bool is_lost(Real missing) const {
    const Real of_next_but_one = Cycle == 1 ? contraction * contraction : contraction;
    return contraction < 1 && of_next_but_one * missing * 1048576 <= round_off;
  }
  // The next increment; of two, if the one before it is not known, as if it fell by a 64th.
  Real next() const {
    if (Cycle == 1) return contraction * size;
    return past[Cycle - 1] > 0 ? contraction * past[Cycle - 1] : size / 64;
  }
  Verdict give_up() {
    if (work > 0) contraction = largest;
    return Verdict::failed;
  }
};
