// NewtonRule of several unknowns in each lane: as the rule of one trajectory does
// (newton_rule_of_many.hpp has the reasons).
template <int Power, int Unknowns>
struct NewtonRuleOfMany : NewtonRule<Power> {
  using One = NewtonRule<Power>;
  Real unit[Unknowns] = {};  // one over the size of each; 0: not known yet
  Real moves[Unknowns] = {};
  Real bends[Unknowns] = {};
  Real before[Unknowns] = {};
  Real fresh = 4;  // steps until the motion is known
  int age = 0;

  static constexpr double smallest = 1 / largest / (epsilon * epsilon * epsilon);

  void forget(const Mask& lanes) {
    One::forget(lanes);
    for (int j = 0; j < Unknowns; ++j) {
      unit[j] = select(lanes, Real(0), unit[j]);
      moves[j] = select(lanes, Real(0), moves[j]);
      bends[j] = select(lanes, Real(0), bends[j]);
    }
    fresh = select(lanes, Real(4), fresh);
  }
  static Real size_of(const Real& length, const Real& moved) {
    const Real value = magnitude(length);
    const Real by = magnitude(moved);
    return value + 32 * select((value > 0) & (value < by), value, by);
  }
  // The sizes, from a first iteration.
  void know(const Real* length, const Real* moved, int count) {
    if (!all(unit[0] > 0)) begin_with(length, moved, count);
  }
  // These are seldom done, and no part of a step's code.
  __attribute__((noinline)) void begin_with(const Real* length, const Real* moved, int count) {
    Real total = 0;
    for (int j = 0; j < count; ++j) total += size_of(length[j], moved[j]);
    const Mask unknown = this->begun & (!(unit[0] > 0)) & (total > 0) & (total <= largest);
    for (int j = 0; j < count; ++j) {
      const Real size = size_of(length[j], moved[j]) + total / 1099511627776;
      unit[j] = select(unknown, 1 / (size + smallest), unit[j]);
    }
  }
  __attribute__((noinline)) void follow(const Real* value, int count, const Mask& lanes) {
    Real least = unit[0];
    for (int j = 1; j < count; ++j) least = select(unit[j] < least, unit[j], least);
    for (int j = 0; j < count; ++j) {
      const Real part = magnitude(value[j]) * unit[j];
      const Mask falls = (part > 0) & (1024 * part < 1) & (unit[j] < 1099511627776 * least);
      const Mask changes = lanes & (falls | (part > 2));
      unit[j] = select(changes, select(falls, 32 * unit[j], 1 / magnitude(value[j])), unit[j]);
      this->unmeasured = this->unmeasured | changes;
    }
  }
  // A step more is known in these lanes, which has come to these values.  Whatever the others do,
  // sizes are looked at in every 16th step.
  void notice(const Real* value, int count, const Mask& lanes) {
    age = (age + 1) % 16;
    const Mask unknown = lanes & (fresh > 0);
    this->unmeasured = this->unmeasured | unknown;
    doubt(unknown);
    fresh = select(unknown, fresh - 1, fresh);
    if (age == 0 && any(lanes)) follow(value, count, lanes);
  }
  // The solution of a step, from the unknown `first` on, before the history records it: in lanes
  // that have come to it so.
  template <class Past, int All>
  void watch(const Past& past, const Real (&solution)[All], int first, int count,
             const Mask& lanes = true) {
    notice(solution + first, count, lanes);
    Real move = 0;
    Real bend = 0;
    Real slowest = largest;
    if (any(lanes)) {
      for (int j = 0; j < count; ++j) {
        moves[j] = select(lanes, past.template difference<0>(solution, first + j), moves[j]);
        bends[j] =
            select(lanes, past.template difference<Power + 1>(solution, first + j), bends[j]);
        const Real part = moves[j] * unit[j];
        move += part;
        bend += bends[j] * unit[j];
        slowest = select(part < slowest, part, slowest);
      }
    }
    this->motion.move = select(lanes, move, Real(0));
    this->motion.bend = select(lanes, bend, Real(0));
    this->motion.least = select(lanes, slowest, Real(0));
    doubt(lanes);
  }
  // Less is not believed.
  void doubt(const Mask& lanes) {
    if (Power == 1) return;
    const Mask too_small = lanes & (1024 * this->contraction < 1);
    this->contraction = select(too_small, Real(1.0 / 1024), this->contraction);
  }
  Mask is_in_reach(const Real* moved, const Real* length, const Real* way, int count) const {
    Mask within = true;
    for (int j = 0; j < count && Power == 2; ++j) {
      const Real part = moved[j] * unit[j];
      const Real move = moves[j] * unit[j];
      const Real shown = bends[j] * unit[j];
      const Real bend = select(shown > part, shown, part);
      const Real round_off = epsilon * felt(magnitude(length[j]), way[j]) * unit[j];
      within = within &
               ((bend <= 1024 * epsilon) | (bend * part * part * 16384 <= round_off * move * move));
    }
    return within;
  }
  // An increment as a part of what it must be lost in, or what the next one is of that; of an
  // approximate matrix the increment, if it is not lost in the rounding of its unknown.
  Real relative(int j, const Real& moved, const Real& length, const Real& way) const {
    if (Power == 1) return select(moved > 8 * epsilon * length + One::tiny, moved, Real(0));
    const Real part = moved / felt(length, way);
    if (this->begins) return select(moved > One::tiny, part, Real(0));
    const Real ratio = moved / before[j];
    const Mask counts = (moved > One::tiny) & (moved * unit[j] > 64 * epsilon);
    return select(counts, select(fresh > 0, part, part * ratio * ratio), Real(0));
  }
  static Real felt(const Real& length, const Real& way) {
    const Real least = 16 * way + epsilon * length;
    return Power == 2 ? select(least < length, least, length) : length;
  }
  // Is even what all unknowns together move by lost in the rounding of one?
  Mask is_lost_in(const Real& length, const Real& size) const {
    if (Power == 1) return size <= 8 * epsilon * length;
    const Real round_off = epsilon * length;
    if (!this->begins) return false;
    const Mask lost = this->contraction * size * size * 16384 <= round_off;
    const Real bend = this->bend_of(size);
    return lost & (bend * size * size * 16384 <= round_off * One::power(this->motion.move));
  }
  // Most steps do, in all lanes.  Twice as strict as what follows is with each lane, which would
  // let none of these go on: whether it is asked depends on the others.
  bool ends_at_once(const Real& size, const Real& shortest, int count) {
    if (this->checks) return false;
    const double round_off = epsilon * count;
    const Real least = 32 * epsilon * shortest;
    const Real shown = select(least < 4 * round_off, least, Real(4 * round_off));
    const Real measured = select(2 * least < round_off, least, Real(round_off / 2));
    const Real slow = this->motion.least;
    const Mask ends = this->is_next_lost(size, measured) & !this->unmeasured &
                      (this->bend_of(size) * size * size * 1048576 <= shown * slow * slow);
    if (!all((!this->open) | ends)) return false;
    this->taken = select(this->open, Real(1), this->taken);
    this->still = false;
    this->open = false;
    return true;
  }
  // By how much each unknown moves, the length that it is rounded with, and its way in the step, or
  // the lengths again where no way counts.
  Mask of_each(const Real* moved, const Real* length, const Real* way, int count, int iterations) {
    know(length, moved, count);
    Real size = moved[0] * unit[0];
    Real least = length[0] * unit[0];
    Real nearest = way[0] * unit[0];
    for (int j = 1; j < count; ++j) {
      size += moved[j] * unit[j];
      const Real part = length[j] * unit[j];
      least = select(part < least, part, least);
      const Real gone = way[j] * unit[j];
      nearest = select(gone < nearest, gone, nearest);
    }
    const Real shortest = way == length ? least : felt(least, nearest);
    if (Power == 2 && iterations == 1 && ends_at_once(size, shortest, count)) return this->open;
    const Mask lost = is_lost_in(shortest, size);
    Real uneven = 0;
    if (!all(lost)) {
      for (int j = 0; j < count; ++j) {
        const Real part = relative(j, moved[j], length[j], way[j]);
        uneven += Power == 1 ? part * unit[j] : part;
      }
      uneven = select(lost, Real(0), uneven);
    }
    Real together = moved[0];
    Real scale = length[0];
    for (int j = 1; j < count; ++j) {
      together += moved[j];
      scale += length[j];
    }
    return judge_all(size, uneven, {*this, moved, length, way, count, together, scale}, iterations);
  }
  // Increments, lengths, ways, and sums of the first two.
  struct Each {
    const NewtonRuleOfMany& rule;
    const Real* moved;
    const Real* length;
    const Real* way;
    int count;
    const Real& together;
    const Real& scale;
    Mask is_within(double units) const { return together <= units * epsilon * scale; }
    Mask is_in_reach() const { return rule.is_in_reach(moved, length, way, count); }
    Mask is_still() const {
      Mask converging = false;
      for (int j = 0; j < count; ++j) {
        const Real by = magnitude(moved[j]);
        converging =
            converging | ((by > 8 * epsilon * magnitude(length[j])) & (2 * by <= rule.before[j]));
      }
      return !converging;
    }
  };
  Mask judge_all(const Real& size, const Real& uneven, const Each& each, int iterations) {
    const Mask moving =
        this->template judge<true>(size, Real(each.count), iterations, uneven, each);
    if (any(this->still)) hear(each.moved, each.count);
    if (any(moving))
      for (int j = 0; j < each.count; ++j) before[j] = magnitude(each.moved[j]);
    return moving;
  }
  // Noise of rounding is no more than 64 roundings of a size: what an iteration has ended with.
  __attribute__((noinline)) void hear(const Real* moved, int count) {
    for (int j = 0; j < count; ++j) {
      const Real noise = magnitude(moved[j]);
      const Mask loud = this->still & (noise * unit[j] > 64 * epsilon);
      unit[j] = select(loud, 64 * epsilon / noise, unit[j]);
    }
  }
  // Of values and increments in arrays, and sums over the unknowns: of increments as parts of
  // sizes, of what is relative of each, of increments and of lengths.
  Mask of_sums(const Real* value, const Real* increment, const Real& size, const Real& uneven,
               const Real& moved, const Real& scale, int count, int iterations) {
    return judge_all(size, uneven, {*this, increment, value, moves, count, moved, scale},
                     iterations);
  }
};
