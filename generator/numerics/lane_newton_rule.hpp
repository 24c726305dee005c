// When to stop Newton's iteration in each lane: as the rule of one trajectory does (newton_rule.hpp
// has the reasons), with a yes or no for every lane.  A lane that is done stands still: its body
// gives the same values again and again, until the last lane is done.  So that lanes stay in step
// the contraction is checked where the number of the step is a multiple of 32, in all of them.
struct Motion {
  Real move = 0;
  Real bend = 0;
};
template <int Power>
struct NewtonRule : Iteration {
  Real contraction = largest;
  Real previous = 0;
  Real grown = 0;
  Mask predicted = false;
  bool checks = false;
  bool begins = true;
  Real far = 0;
  Motion motion;

  static constexpr double tiny = 64 * epsilon / largest;
  static Real power(const Real& size) { return Power == 2 ? size * size : size; }
  // From a prediction, or else from the state itself.
  void begin(const Mask& from_prediction, const Turn& turn) {
    Iteration::begin(turn);
    grown = 0;
    if (Power == 1) far = 0;
    predicted = from_prediction;
    checks = turn.is_check();
    begins = true;
  }
  // Nothing is known any more in lanes that begin again from the state.
  void forget(const Mask& lanes) {
    contraction = select(lanes, Real(largest), contraction);
    motion.move = select(lanes, Real(0), motion.move);
    motion.bend = select(lanes, Real(0), motion.bend);
  }
  // The solution of a step, from the unknown `first` on, before the history records it.
  template <class Past, int Unknowns>
  void watch(const Past& past, const Real (&solution)[Unknowns], int first, int count) {
    motion.move = past.template error<0>(solution, first, count);
    motion.bend = past.template error<Power + 1>(solution, first, count);
  }
  // What an increment is of what it must be lost in, or the increment.
  static Real relative(const Real& moved, const Real& length, const Real& way) {
    if (Power == 1) return select(moved > 8 * epsilon * length + tiny, moved, Real(0));
    return select(moved > tiny, moved / felt(length, way), Real(0));
  }
  static Real felt(const Real& length, const Real& way) {
    const Real least = 16 * way + length / 1048576;
    return Power == 2 ? select(least < length, least, length) : length;
  }
  // Is even what all unknowns together move by lost in the rounding of one?
  Mask is_lost_in(const Real& length, const Real& size) const {
    if (Power == 1) return size <= 8 * epsilon * length;
    const Real round_off = epsilon * length;
    const Mask lost = contraction * size * size * 16 <= round_off;
    if (!begins) return lost;
    return lost & (motion.bend * size * size * 16 <= round_off * power(motion.move));
  }
  // By how much each unknown moves, the length that it is rounded with, and its way in the step, or
  // the lengths again where no way counts.
  Mask of_each(const Real* moved, const Real* length, const Real* way, int count, int iterations) {
    Real size = moved[0];
    Real scale = length[0];
    Real least = length[0];
    Real nearest = way[0];
    for (int j = 1; j < count; ++j) {
      size += moved[j];
      scale += length[j];
      least = select(length[j] < least, length[j], least);
      nearest = select(way[j] < nearest, way[j], nearest);
    }
    const Mask lost = is_lost_in(way == length ? least : felt(least, nearest), size);
    Real uneven = 0;
    if (!all(lost)) {
      for (int j = 0; j < count; ++j) uneven += relative(moved[j], length[j], way[j]);
      uneven = select(lost, Real(0), uneven);
    }
    return (*this)(size, scale, iterations, uneven);
  }
  // The numbers are those that the rule of one trajectory is given.  Gives the lanes that move.
  Mask operator()(const Real& size, const Real& scale, int iterations,
                  const Real& uneven = Real(0)) {
    const Real round_off = epsilon * scale;
    const Real parts = size * uneven;
    const Mask waits = waited_for(uneven, round_off);
    const bool first = iterations == 1 && !checks;
    const Mask alone = first ? is_lost(size, round_off) & serves(parts, waits, false) : Mask(false);
    if (first && all((!open) | alone)) {
      taken = select(open, Real(1), taken);
      open = false;
      return open;
    }
    taken = select(open, Real(iterations), taken);
    end_with(open & !(size <= largest), size);
    Mask done = size <= round_off;
    if (Power == 1) {
      const Mask leaves = contraction * size * 8192 > round_off;
      done = done & !waits & !(iterations > 1 ? leaves & (previous > round_off) : leaves);
    }
    if (iterations > 1) {
      done = done | (learn(size, round_off) & !waits);
      done = done | (is_next_lost(size, round_off) & serves(parts, waits, true));
    } else {
      done = done | alone;
    }
    open = open & !done;
    if (iterations > 1) {
      end_with(open & predicted & (2 * size > previous) & (size > 4096 * round_off), size);
    }
    if (iterations >= 60) end_with(open, size);
    previous = size;
    begins = false;
    return open;
  }
  // Is more to be had of unknowns of which an approximate matrix leaves more than their rounding?
  Mask waited_for(const Real& uneven, const Real& round_off) {
    if (Power == 2) return false;
    const Mask stays = (far > 0) & (10 * uneven > 9 * far);
    far = uneven;
    return (uneven > epsilon * epsilon * round_off) & !stays;
  }
  Mask serves(const Real& parts, const Mask& waits, bool measured) const {
    return Power == 1 ? !waits : is_even(parts, measured);
  }
  // Lanes that make no progress any more.
  Mask learn(const Real& size, const Real& round_off) {
    const Real seen = select(size < round_off, round_off, size) / power(previous);
    // It may rise at once but falls slowly: one small increment may be luck.
    const Mask rises = (contraction >= largest) | ((size > 64 * round_off) & (seen > contraction));
    const Mask falls = open & !rises & (seen < contraction);
    const Real lower = select(4 * seen < contraction, contraction / 4, seen);
    contraction = select(open & rises, select(seen < largest, seen, Real(largest)),
                         select(falls, lower, contraction));
    grown = select(open, select(size < previous, Real(0), grown + 1), grown);
    return (grown >= 2) & (size <= 4096 * round_off);
  }
  // Would the next increment be?
  Mask is_next_lost(const Real& size, const Real& round_off) const {
    return contraction * power(size) * 1048576 <= round_off;
  }
  // The same of the first.
  Mask is_lost(const Real& size, const Real& round_off) const {
    return is_next_lost(size, round_off) & is_straight(size, round_off);
  }
  // Is the next increment lost in the rounding of each unknown?
  Mask is_even(const Real& parts, bool measured) const {
    const Mask even = contraction * parts * 16 <= epsilon;
    if (measured) return even;
    return even & (motion.bend * parts * 16 <= epsilon * power(motion.move));
  }
  // Is bend (size / move)^Power lost in rounding?
  Mask is_straight(const Real& size, const Real& round_off) const {
    const Real bend = select(motion.bend > size, motion.bend, size);
    return bend * power(size) * 1024 <= round_off * power(motion.move);
  }
};
