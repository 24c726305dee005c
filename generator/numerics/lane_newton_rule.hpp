// When to stop Newton's iteration in each lane: as the rule of one trajectory does (newton_rule.hpp
// has the reasons), with a yes or no for every lane.  A lane that is done stands still: its body
// gives the same values again and again, until the last lane is done.  So that lanes stay in step
// the contraction is checked where the number of the step is a multiple of 32, in all of them.
struct Motion {
  Real move = 0;
  Real bend = 0;
  Real least = 0;  // the least move of several unknowns
};
template <int Power>
struct NewtonRule : Iteration {
  Real contraction = largest;
  Real previous = 0;
  Real grown = 0;
  Mask predicted = false;
  bool checks = false;
  bool begins = true;
  Mask still = false;       // lanes that have ended with noise
  Mask unmeasured = false;  // lanes whose contraction is to be measured before it is believed
  Real far = 0;
  Motion motion;

  static constexpr double tiny = 64 * epsilon / largest;
  static Real power(const Real& size) { return Power == 2 ? size * size : size; }
  // From a prediction, or else from the state itself.
  void begin(const Mask& from_prediction, const Turn& turn) {
    Iteration::begin(turn);
    grown = 0;
    far = 0;
    predicted = from_prediction;
    checks = turn.is_check();
    begins = true;
  }
  // Nothing is known any more in lanes that begin again from the state.
  void forget(const Mask& lanes) {
    contraction = select(lanes, Real(largest), contraction);
    motion.move = select(lanes, Real(0), motion.move);
    motion.bend = select(lanes, Real(0), motion.bend);
    motion.least = select(lanes, Real(0), motion.least);
  }
  // The solution of a step, from the unknown `first` on, before the history records it.
  template <class Past, int Unknowns>
  void watch(const Past& past, const Real (&solution)[Unknowns], int first, int count) {
    motion.move = past.template error<0>(solution, first, count);
    motion.bend = past.template error<Power + 1>(solution, first, count);
  }
  // The numbers are those that the rule of one trajectory is given.  Gives the lanes that move.
  Mask operator()(const Real& size, const Real& scale, int iterations) {
    return judge<false>(size, scale, iterations, Real(0), Alone{size, scale});
  }
  struct Alone {
    const Real& size;
    const Real& scale;
    Mask is_within(double units) const { return size <= units * epsilon * scale; }
    static Mask is_still() { return true; }
    static Mask is_in_reach() { return true; }
  };
  template <bool Many, class Unknown>
  Mask judge(const Real& size, const Real& scale, int iterations, const Real& uneven,
             const Unknown& each) {
    const Real round_off = epsilon * scale;
    still = false;
    const Mask stays = (far > 0) & (10 * uneven > 9 * far);
    far = uneven;
    Mask waits = false;
    if (Power == 1) waits = (uneven > epsilon * epsilon * round_off) & !stays;
    const bool first = iterations == 1 && !checks;
    Mask served = Power == 1 ? !waits : is_even(size, uneven, iterations > 1);
    if (Many && iterations == 1) served = served & each.is_in_reach();
    const Mask alone = first ? is_lost<Many>(size, scale) & served & !unmeasured : Mask(false);
    if (first && all((!open) | alone)) {
      taken = select(open, Real(1), taken);
      open = false;
      return open;
    }
    taken = select(open, Real(iterations), taken);
    end_with(open & !(size <= largest), size);
    Mask done = alone;
    Mask noise = false;
    if (iterations > 1) {
      noise = each.is_within(4096);
      const double least = Power == 2 ? 8 : 2;
      const Mask slow = Many ? least * size > previous : size >= previous;
      learn(size, round_off, Many ? slow : Mask(false));
      unmeasured = unmeasured & !open;
      grown = select(open, select(slow, grown + 1, Real(0)), grown);
      const Mask small = Many ? 4096 * size <= scale : Mask(true);
      done = (grown >= 2) & small & noise & !waits & each.is_still();
      still = open & done;
    }
    Mask lost = (size <= round_off) & (served | stays);
    if (Power == 1) {
      const Mask leaves = contraction * size * 8192 > round_off;
      lost = lost & !(iterations > 1 ? leaves & (previous > round_off) : leaves);
    }
    done = done | lost;
    if (iterations > 1) {
      const Mask reaches =
          Many && Power == 2 ? size * size * size <= epsilon * round_off : Mask(true);
      done = done | (is_next_lost(size, round_off) & served & reaches);
    }
    open = open & !done;
    if (iterations > 1) end_with(open & predicted & (2 * size > previous) & !noise, size);
    if (iterations >= 60) {
      if (Many) open = open & !each.is_within(64);
      end_with(open, size);
    }
    previous = size;
    begins = false;
    return open;
  }
  void learn(const Real& size, const Real& round_off, const Mask& doubtful) {
    const Real seen = select(size < round_off, round_off, size) / power(previous);
    // It may rise at once but falls slowly: one small increment may be luck.
    const Mask seen_more = !doubtful & (size > 64 * round_off) & (seen > contraction);
    const Mask rises = (contraction >= largest) | seen_more;
    const Mask falls = open & !rises & (seen < contraction);
    const Real lower = select(4 * seen < contraction, contraction / 4, seen);
    contraction = select(open & rises, select(seen < largest, seen, Real(largest)),
                         select(falls, lower, contraction));
  }
  // Would the next increment be?
  Mask is_next_lost(const Real& size, const Real& round_off) const {
    return contraction * power(size) * 1048576 <= round_off;
  }
  // The same of the first.
  template <bool Many>
  Mask is_lost(const Real& size, const Real& scale) const {
    const Real round_off = epsilon * scale;
    return is_next_lost(size, round_off) & is_straight(size, Many ? 8 * round_off : seen_in(scale));
  }
  // What the motion shows must be lost in this, of a single unknown.
  Real seen_in(const Real& scale) const {
    const Real near = 1024 * motion.move + epsilon * scale;
    return epsilon * select(near < scale, near, scale);
  }
  // Is the next increment lost in the rounding of each unknown?
  Mask is_even(const Real& size, const Real& uneven, bool measured) const {
    if (measured) return uneven * 16384 <= epsilon;
    const Real parts = size * uneven;
    return (contraction * parts * 16384 <= epsilon) &
           (bend_of(size) * parts * 16384 <= epsilon * power(motion.move));
  }
  // Is bend (size / move)^Power lost in rounding?
  Mask is_straight(const Real& size, const Real& round_off) const {
    return bend_of(size) * power(size) * 1048576 <= round_off * power(motion.move);
  }
  Real bend_of(const Real& size) const { return select(motion.bend > size, motion.bend, size); }
};
