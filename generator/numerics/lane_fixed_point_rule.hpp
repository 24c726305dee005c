// How far an iteration has moved in each lane, as for one trajectory (fixed_point_rule.hpp).
struct Distance {
  // Over so many units of rounding what is not linear is far below them.
  double units = 16384;
  void narrow() { units = 64; }  // in loops
  // What is less than this of the whole is not waited for.
  static constexpr double lost = epsilon * epsilon * epsilon;
  // What is rounded like this.
  static constexpr double tiny = 1 / largest;
  Real size = 0;
  Real scale = 0;
  Real far = 0;

  Real far_of(const Real& moved, const Real& length) const {
    return select(moved <= units * epsilon * (length + tiny), Real(0), moved);
  }
  Mask near() const { return far <= lost * scale; }
  Real round_off() const { return epsilon * (scale + 64 * tiny); }

  void add(const Real& moved, const Real& length) {
    size += moved;
    scale += length;
    far += far_of(moved, length);
  }
  // Arrays of them, rounded with what stands beside.
  void add(const Real* moved, const Real* value, const Real* beside, int count) {
    size += sum_of(count, [&](int j) { return magnitude(moved[j]); });
    scale += sum_of(count, [&](int j) {
      const Real length = magnitude(value[j]) + magnitude(beside[j]);
      far += far_of(magnitude(moved[j]), length);
      return length;
    });
  }
};
// Of these lanes, which are done and which have failed?
struct Judgement {
  Mask done = false;
  Mask failed = false;
};
// When to stop an iteration in each lane that has no other end than rounding.  The last increment
// of a lane is made behind the loop, or what the body gives then is not read.
template <int Cycle>
struct FixedPointRule : Iteration {
  Real least[Cycle] = {};  // 0 before the first increment
  Real size = 0;           // of the last increment
  Real before = 0;         // and of the one before it in this step, if there is one
  Real contraction = 1;    // of these two, in the step before
  Mask known = false;      // has it been measured?
  bool checks = false;
  Real stuck = 0;
  Real begun = 0;  // the largest of the first four increments

  void begin(const Turn& turn) {
    Iteration::begin(turn);
    begun = 0;
    checks = turn.is_check();
    for (Real& smallest : least) smallest = 0;
    stuck = 0;
    const Mask measured = turn.lanes & (before > 0);
    contraction = select(measured, select(size < before, size / before, Real(1)), contraction);
    known = known | measured;
    size = select(turn.lanes, Real(0), size);
  }
  Judgement judge(const Distance& moved, int iterations) {
    taken = select(open, Real(iterations), taken);
    before = select(open, size, before);
    size = select(open, moved.size, size);
    const Mask finite = size <= largest;
    Real& smallest = least[iterations % Cycle];
    const Mask decreased = (smallest <= 0) | (size < smallest);
    smallest = select(decreased, size, smallest);
    stuck = select(decreased, Real(0), stuck + 1);
    const Real round_off = moved.round_off();
    const Mask rests = ((stuck >= 2) & (size <= 64 * round_off)) |
                       ((stuck >= 3) & (size <= 512 * round_off)) |
                       ((stuck >= 4) & (size <= 4096 * round_off));
    const Mask done = finite & ((moved.near() & (size <= 64 * round_off)) | rests);
    // What still decreases then does so by a few hundredths at a time: much more is missing.
    Mask lost = !finite;
    if (iterations <= 4) {
      begun = select(size > begun, size, begun);
    } else {
      lost = lost | (size > 1024 * begun);
    }
    return {done & !lost, lost | (Mask(iterations >= 500) & !done)};
  }
  // Gives the lanes that go on.
  Mask end(const Judgement& judgement) {
    end_with(open & judgement.failed, size);
    open = open & !judgement.done;
    return open;
  }
  Mask operator()(const Distance& moved, int iterations) {
    Judgement judgement = judge(moved, iterations);
    judgement.done = judgement.done | (comes_near(moved) & !judgement.failed);
    return end(judgement);
  }
  // Of an iteration that has been judged: see Note [what is lost in rounding] of the rule of
  // one trajectory.
  Mask comes_near(const Distance& moved) {
    const Real most = 8 * moved.round_off();
    const Mask measured = (size * size <= most * before) & (size < before);
    const Mask told = Mask(!checks) & known & (4 * contraction * size <= most);
    return moved.near() & ((measured & (before > 0)) | (told & !(before > 0)));
  }
};
