// NewtonRule of several unknowns.
//
// Note [units]
// Nothing may hang on the units in which they are written: sums of what is 1e-5 in one unknown and
// 1 in another do not see the wall that the first runs into, and were off by 5e6 roundings.  So
// increments are added as parts of the sizes that their unknowns have had.  In every 16th step a
// size is taken anew where its unknown has become more than twice as large, and is a 32nd where
// that is less than a 2^-10th of it.  The first one is the unknown and 32 times what it moves by,
// so that it may begin at zero, and at least a 2^-40th of all together.  In what is as small,
// rounding errors of the others may be most of an increment: whether it may be noise is asked of
// plain sums, and what an iteration has ended with as noise is 64 roundings of a size from then on.
//
// Note [what its own motion shows of each]
// A sum is loud where most of it is: a free particle goes a 30th in a step, and nothing in it shows
// that another one comes to a wall exp(1e5 (y - 1)) with a 1e5th.  So each unknown is also asked by
// itself whether its bend (increment / move)^2 is lost, a 2^-14th of its rounding at most, with the
// increment for the bend where that is larger, and as long as it is more than noise can be.  Where
// increments were measured the next one of each is told by its own last two, moved (moved /
// before)^2, and no step ends with noise as long as an unknown converges.  Walls beside a loud
// coordinate were off by 8000 roundings, an x that falls by 1e4 times within its size by 290, what
// is a 1e13th of its neighbour by 1e17.
//
// In the first four steps, of which no motion is known, the first increment is that of the motion,
// and tells nothing of what moves together: of pairs in free flight the next one was told to be
// lost, and their distance was off by up to 1e6.  There an increment must be lost itself, and none
// ends a step as the first.  Nor may the contraction that is seen be believed where it is next to
// none: a pair that moves as a whole shows 1e-9, and what begins at zero, as long as its size is
// taken to be far too small, is most of the sum and as linear; the pair's own swings, 1 to 10,
// were off by 6e7 and by 800 roundings.  So it is a 2^-10th at least: with the matrix, which shows
// what is curved, in those steps alone, and else in all.  Nor does what follows a first increment
// tell the contraction of a swing, where that was of the pair: it must be less than epsilon^(2/3).
//
// Note [what every unknown lacks]
// Where a step moves by the gradient of the last iteration and H'' times the increment, what is of
// second order stays where it is: a bead at rest whose neighbour is hit was off by 57 roundings. Of
// each the first increment is taken to leave the same part as all together; `uneven` is the sum of
// what the increments are of their unknowns, or what is told to follow them.  With an approximate
// matrix that would be wrong: an unknown that is small beside the others may contract far more
// slowly, and was off by 2e4 of its roundings.  `uneven` is then the sum of the increments beyond 8
// roundings of their own unknowns, and none may be left, as long as they become smaller.
//
// Nor is it enough that an increment is lost in the rounding of its unknown: a coordinate that
// hardly moves is moved by a momentum of 1/h times its way, which is torn out of the equations and
// asked by nobody.  Of beads between walls, close to their turning points, momenta were off by 76
// of their roundings.  So 16 times the way that the step has moved it stands for its length where
// that is less (a 2^-10th of a rounding of the momentum then), and one rounding of its length, for
// what never moves: a 2^-20th of it was as if something 1e12 times as heavy as what it is hit by
// had no momentum.
//
template <int Power, int Unknowns>
struct NewtonRuleOfMany : NewtonRule<Power> {
  using One = NewtonRule<Power>;
  Real unit[Unknowns] = {};   // one over the size of each, see Note [units]; 0: not known yet
  Real moves[Unknowns] = {};  // the motion of each, as it is written
  Real bends[Unknowns] = {};
  Real before[Unknowns] = {};  // by how much each moved in the iteration before
  int age = 0;
  int fresh = 4;  // steps until the motion is known

  static constexpr Real smallest = 1 / largest / (epsilon * epsilon * epsilon);

  // A first increment that is beyond the unknown may have gone astray.
  static Real size_of(Real length, Real moved) {
    const Real value = magnitude(length);
    const Real by = magnitude(moved);
    return value + 32 * (value > 0 && value < by ? value : by);
  }
  // The sizes, from a first iteration.
  void know(const Real* length, const Real* moved, int count) {
    if (!(unit[0] > 0)) begin_with(length, moved, count);
  }
  // These are seldom done, and no part of a step's code.
  __attribute__((noinline)) void begin_with(const Real* length, const Real* moved, int count) {
    Real total = 0;
    for (int j = 0; j < count; ++j) total += size_of(length[j], moved[j]);
    if (!(total > 0 && total <= largest)) return;
    for (int j = 0; j < count; ++j)
      unit[j] = 1 / (size_of(length[j], moved[j]) + total / 1099511627776 + smallest);
  }
  // Where a size is another one, the contraction is measured anew in the next step.
  __attribute__((noinline)) void follow(const Real* value, int count) {
    age = 0;
    Real least = unit[0];
    for (int j = 1; j < count; ++j) least = unit[j] < least ? unit[j] : least;
    for (int j = 0; j < count; ++j) {
      const Real part = magnitude(value[j]) * unit[j];
      const bool falls = part > 0 && 1024 * part < 1 && unit[j] < 1099511627776 * least;
      if (part <= 2 && !falls) continue;
      unit[j] = falls ? 32 * unit[j] : 1 / magnitude(value[j]);
      this->unchecked = 32;
    }
  }
  // A step more is known, which has come to these values.
  void notice(const Real* value, int count) {
    if (++age >= 16) follow(value, count);
    if (fresh <= 0) return;
    --fresh;
    this->unchecked += 32;
    doubt();
  }
  // Less is not believed.
  void doubt() {
    if (Power == 2 && 1024 * this->contraction < 1) this->contraction = Real(1) / 1024;
  }
  // The solution of a step, from the unknown `first` on, before the history records it.
  template <class Past, class Solution>
  void watch(const Past& past, const Solution& solution, int first, int count) {
    notice(&solution[first], count);
    Real move = 0;
    Real bend = 0;
    Real slowest = largest;
    for (int j = 0; j < count; ++j) {
      moves[j] = past.difference(0, solution, first + j);
      bends[j] = past.difference(Power + 1, solution, first + j);
      const Real part = moves[j] * unit[j];
      move += part;
      bend += bends[j] * unit[j];
      slowest = part < slowest ? part : slowest;
    }
    this->motion = {move, bend, slowest};
    doubt();
  }
  // See Note [what its own motion shows of each].
  bool is_in_reach(const Real* moved, const Real* length, const Real* way, int count) const {
    for (int j = 0; j < count && Power == 2; ++j) {
      const Real part = moved[j] * unit[j];
      const Real move = moves[j] * unit[j];
      const Real shown = bends[j] * unit[j];
      const Real bend = shown > part ? shown : part;
      const Real round_off = epsilon * felt(magnitude(length[j]), way[j]) * unit[j];
      // Noise is 64 roundings of a size, see `hear`, and its fourth difference 16 times as much.
      if (bend <= 1024 * epsilon) continue;
      if (bend * part * part * 16384 > round_off * move * move) return false;
    }
    return true;
  }
  // An increment as a part of what it must be lost in, or what the next one is of that, if it is no
  // noise; nothing at the smallest numbers.  Of an approximate matrix the increment, if it is not
  // lost in the rounding of its unknown.
  Real relative(int j, Real moved, Real length, Real way) const {
    if (Power == 1) return moved > 8 * epsilon * length + One::tiny ? moved : Real(0);
    if (!(moved > One::tiny)) return 0;
    if (this->previous <= 0) return moved / felt(length, way);
    if (moved * unit[j] <= 64 * epsilon) return 0;
    if (fresh > 0) return moved / felt(length, way);
    const Real ratio = moved / before[j];
    return moved / felt(length, way) * ratio * ratio;
  }
  // Of its length and its way in the step.
  static Real felt(Real length, Real way) {
    const Real least = 16 * way + epsilon * length;
    return Power == 2 && least < length ? least : length;
  }
  // Is even what all unknowns together move by lost in the rounding of one?  The least of them
  // answers for all: no more need be asked.
  bool is_lost_in(Real length, Real size) const {
    if (Power == 1) return size <= 8 * epsilon * length;
    return this->contraction * size * size * 16384 <= epsilon * length;
  }
  // The same of what the motion shows.
  bool bends_little(Real length, Real size) const {
    const Real bend = this->bend_of(size);
    return Power == 1 ||
           bend * size * size * 16384 <= epsilon * length * One::power(this->motion.move);
  }
  // By how much each unknown moves, the length that it is rounded with, and its way in the step, or
  // the lengths again where no way counts.
  Verdict of_each(const Real* moved, const Real* length, const Real* way, int count,
                  int iterations) {
    const Seen seen = sums_of(moved, length, way, count);
    // What is 2^14 times lost in the rounding of the least unknown is 2^20 times lost in 2^6 times
    // it: with the factor of ends_at_once.
    const Real round_off = epsilon * Real(count);
    const Real least = 64 * epsilon * seen.shortest;
    const Real shown = Power == 2 && least < 8 * round_off ? least : 8 * round_off;
    const Real measured = Power == 2 && least < round_off ? least : round_off;
    const bool even = Power == 2 || is_lost_in(seen.shortest, seen.size);
    // Of each the same where it is so of the one that moves least.
    const Real move = Power == 2 ? this->motion.least : this->motion.move;
    if (iterations == 1 && even && this->ends_at_once(seen.size, shown, measured, move))
      return Verdict::done;
    return judge_each(seen, moved, length, way, count, iterations);
  }
  struct Seen {
    Real size, shortest;
  };
  Seen sums_of(const Real* moved, const Real* length, const Real* way, int count) const {
    Real size = moved[0] * unit[0];
    Real least = length[0] * unit[0];
    Real nearest = way[0] * unit[0];
    for (int j = 1; j < count; ++j) {
      size += moved[j] * unit[j];
      const Real part = length[j] * unit[j];
      least = part < least ? part : least;
      const Real gone = way[j] * unit[j];
      nearest = gone < nearest ? gone : nearest;
    }
    return {size, way == length ? least : felt(least, nearest)};
  }
  __attribute__((noinline)) Verdict judge_each(Seen seen, const Real* moved, const Real* length,
                                               const Real* way, int count, int iterations) {
    if (!(unit[0] > 0)) {
      begin_with(length, moved, count);
      seen = sums_of(moved, length, way, count);
    }
    Real uneven = 0;
    // What this step has measured is not known yet where there is something to measure.
    const bool asked = Power == 1 || this->previous <= 0;
    const bool lost =
        asked && bends_little(seen.shortest, seen.size) && is_lost_in(seen.shortest, seen.size);
    if (!lost) {
      for (int j = 0; j < count; ++j) {
        uneven += relative(j, moved[j], length[j], way[j]) * (Power == 1 ? unit[j] : Real(1));
      }
    }
    Real together = moved[0];
    Real scale = length[0];
    for (int j = 1; j < count; ++j) {
      together += moved[j];
      scale += length[j];
    }
    return judge_all(seen.size, uneven, {*this, moved, length, way, count, together, scale},
                     iterations);
  }
  // Increments, lengths, ways, and sums of the first two.
  struct Each {
    const NewtonRuleOfMany& rule;
    const Real* moved;
    const Real* length;
    const Real* way;
    int count;
    Real together, scale;
    bool is_within(Real units) const { return together <= units * epsilon * scale; }
    bool is_in_reach() const { return rule.is_in_reach(moved, length, way, count); }
    bool is_still() const {
      bool converging = false;
      for (int j = 0; j < count; ++j) {
        const Real by = magnitude(moved[j]);
        converging =
            converging || (by > 8 * epsilon * magnitude(length[j]) && 2 * by <= rule.before[j]);
      }
      return !converging;
    }
  };
  Verdict judge_all(Real size, Real uneven, const Each& each, int iterations) {
    const Verdict verdict =
        this->template judge<true>(size, Real(each.count), iterations, uneven, each);
    if (this->still) hear(each.moved, each.count);
    if (verdict == Verdict::go_on)
      for (int j = 0; j < each.count; ++j) before[j] = magnitude(each.moved[j]);
    return verdict;
  }
  // Noise of rounding is no more than 64 roundings of a size: what an iteration has ended with.
  __attribute__((noinline)) void hear(const Real* moved, int count) {
    for (int j = 0; j < count; ++j) {
      const Real noise = magnitude(moved[j]);
      if (noise * unit[j] > 64 * epsilon) unit[j] = 64 * epsilon / noise;
    }
  }
  // Of values and increments in arrays, and sums over the unknowns: of increments as parts of
  // sizes, of what is relative of each, of increments and of lengths.
  Verdict of_sums(const Real* value, const Real* increment, Real size, Real uneven, Real moved,
                  Real scale, int count, int iterations) {
    return judge_all(size, uneven, {*this, increment, value, moves, count, moved, scale},
                     iterations);
  }
};
