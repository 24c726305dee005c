// When to stop Newton's iteration: at round-off.  Increments shrink as
//   next <= contraction * size^Power,
// Power = 2 with the exact matrix, 1 with an approximate one.  The last increment still enters the
// solution, so an iteration may stop when the next one would be lost in rounding.
//
// Note [what one increment leaves]
// The contraction is measured, kept from step to step and checked at least every 32nd step.  What
// is cut off is a bias where rounding is a random walk, and in the momenta it counts 1/h times: the
// factor 2^-20 keeps it below the sum of the rounding errors.
//
// But a contraction of 32 steps ago knows nothing of a wall that has come near since, and next to
// rounding none can be measured.  The motion itself shows how curved the equations are where it is:
// in a step the solution moves by `move`, its second difference is h^2 times a force, and so
//   bend, its difference of order 2 + Power, is h^2 |force^(Power)| move^Power,
// while an increment leaves h^2 |force^(Power)| size^Power or less (an approximate matrix is taken
// to be no worse than the unit matrix), that is bend (size/move)^Power.  A step of one increment
// needs this to be lost in rounding too.  Both are those of the step before, or the increment where
// it is larger than bend, and count 2^20 times, as what is measured does: for a force that has
// grown since, for an increment across the motion, and for the bias.  Counted 2^10 times, between
// walls exp(40 (q - 1)) at h = 0.005 the energy fell by 1.9e-19 of itself in every step.  Of
// several unknowns, each in its own unit, they count 2^17 times, and where each is asked by itself
// a 2^-14th of its rounding is what an increment may leave, measured or not: the bend of a linear
// oscillation, which leaves nothing, is counted as well.  (With a 16th twelve between such walls
// lost 5e-4 of their roundings a step.)
//
// Note [what is below rounding]
// An increment below rounding ends an exact iteration.  Of an approximate one it leaves the
// contraction times itself: a hundredth of a rounding error, but the same way at every step.  Of
// Kepler's orbit (order 4, h = 0.1) the angular momentum fell by 1.6e-4 roundings a step.  Where
// that counts one more increment follows, which is made of rounding alone.
//
// Note [a prediction is followed while increments halve]
// They do where Newton and Kantorovich's theorem promises a solution, which then is not further
// away than twice the first.  A prediction that ends beyond a pole of the force wanders, and may
// come to another solution of the equations than the motion's: that is a failure, and the step is
// tried again from the state.
struct Motion {
  Real move = 0;
  Real bend = 0;
  Real least = 0;  // the least move of several unknowns
};
template <int Power>
struct NewtonRule {
  Real contraction = largest;
  int unchecked = 32;  // steps since it was measured
  Real previous = 0;   // what the last increment was
  int grown = 0;
  bool predicted = false;
  Real far = 0;        // what was uneven in the iteration before
  bool still = false;  // has it ended with noise?
  Motion motion;

  static constexpr Real tiny = 64 * epsilon / largest;  // next to the smallest number
  static Real power(Real size) { return Power == 2 ? size * size : size; }
  // From a prediction, or else from the state itself.
  void begin(bool from_prediction) {
    previous = 0;
    predicted = from_prediction;
  }
  // The solution of a step, from the unknown `first` on, before the history records it.
  template <class Past, class Solution>
  void watch(const Past& past, const Solution& solution, int first, int count) {
    motion.move = past.error(0, solution, first, count);
    motion.bend = past.error(Power + 1, solution, first, count);
  }
  // size, scale: of the increment and of the value.
  Verdict operator()(Real size, Real scale, int iterations) {
    const Real round_off = epsilon * scale;
    if (iterations == 1 && ends_at_once(size, seen_in(scale), round_off, motion.move))
      return Verdict::done;
    return judge<false>(size, scale, iterations, 0, Alone{size, scale});
  }
  // Most steps do, with their first increment: where what the motion shows, and what was measured,
  // is lost in this.
  bool ends_at_once(Real size, Real shown, Real measured, Real move) {
    const bool ends =
        unchecked < 31 && is_straight(size, shown, move) && is_next_lost(size, measured);
    unchecked += ends;
    return ends;
  }
  struct Alone {
    Real size, scale;
    bool is_within(Real units) const { return size <= units * epsilon * scale; }
    static bool is_still() { return true; }
    static bool is_in_reach() { return true; }
  };
  // The same of several unknowns, see NewtonRuleOfMany, of which it is asked whether the increments
  // are within so many units of rounding of them all, whether none converges any more, and whether
  // what its own motion shows of each is lost.
  template <bool Many, class Unknown>
  Verdict judge(Real size, Real scale, int iterations, Real uneven, const Unknown& each) {
    const Real round_off = epsilon * scale;
    still = false;
    if (!(size <= largest)) {
      previous = size;
      return Verdict::failed;
    }
    const bool first = previous <= 0;
    const bool stays = Many && !first && far > 0 && 10 * uneven > 9 * far;
    const bool waits = Power == 1 && uneven > epsilon * epsilon * round_off && !stays;
    far = uneven;
    if (first) {
      ++unchecked;
      grown = 0;
    } else {
      // Of several unknowns, of which some may be noise while others converge, increments must
      // become less by more than that.
      const Real least = Power == 2 ? 8 : 2;
      const bool slow = Many ? least * size > previous : size >= previous;
      learn(size, round_off, Many && slow);
      unchecked = 0;
      // No progress twice in a row: this is round-off if it is small, else it may still recover.
      grown = slow ? grown + 1 : 0;
      const bool small = !Many || 4096 * size <= scale;
      still = grown >= 2 && small && !waits && each.is_within(4096) && each.is_still();
      if (still) return Verdict::done;
    }
    const bool near = !Many || !first || each.is_in_reach();
    const bool serves = near && (Power == 1 ? !waits : uneven <= 0 || is_even(size, uneven));
    if (size <= round_off && is_chance(size, round_off) && (serves || stays)) return Verdict::done;
    const Real shown = Many ? 8 * round_off : seen_in(scale);
    const bool looked = !first || (unchecked < 32 && is_straight(size, shown, motion.move));
    const bool reaches = !Many || first || Power == 1 || size * size * size <= epsilon * round_off;
    if (looked && serves && reaches && is_next_lost(size, round_off)) return Verdict::done;
    const bool astray = predicted && iterations > 1 && 2 * size > previous && !each.is_within(4096);
    previous = size;
    // Noise may turn in circles and never be twice in a row what it was.
    if (Many && iterations >= 60 && each.is_within(64)) return Verdict::done;
    return iterations < 60 && !astray ? Verdict::go_on : Verdict::failed;
  }
  // It may rise at once but falls slowly: one small increment may be luck.  Of several unknowns it
  // does not rise where nothing converges.
  void learn(Real size, Real round_off, bool doubtful) {
    const Real seen = (size < round_off ? round_off : size) / power(previous);
    const bool rises = !doubtful && size > 64 * round_off && seen > contraction;
    if (contraction >= largest || rises) {
      contraction = seen < largest ? seen : largest;
    } else if (seen < contraction) {
      contraction = 4 * seen < contraction ? contraction / 4 : seen;
    }
  }
  bool is_next_lost(Real size, Real round_off) const {
    return contraction * power(size) * 1048576 <= round_off;
  }
  // See Note [what is below rounding].
  bool is_chance(Real size, Real round_off) const {
    return Power == 2 || (previous > 0 && previous <= round_off) ||
           contraction * size * 8192 <= round_off;
  }
  // Is the next increment lost in the rounding of each unknown?  See Note [what every unknown
  // lacks].
  bool is_even(Real size, Real uneven) const {
    if (previous > 0) return uneven * 16384 <= epsilon;
    const Real parts = size * uneven;
    return contraction * parts * 16384 <= epsilon &&
           bend_of(size) * parts * 16384 <= epsilon * power(motion.move);
  }
  // Is bend (size / move)^Power lost in rounding?
  bool is_straight(Real size, Real round_off, Real move) const {
    return bend_of(size) * power(size) * 1048576 <= round_off * power(move);
  }
  // What the motion shows must be lost in the rounding of a single unknown, and in that of 1024
  // times its way: a momentum that moves it may be torn out, and is rounded as that.
  Real seen_in(Real scale) const {
    const Real near = 1024 * motion.move + epsilon * scale;
    return epsilon * (near < scale ? near : scale);
  }
  // See Note [what one increment leaves].
  Real bend_of(Real size) const { return motion.bend > size ? motion.bend : size; }
};
