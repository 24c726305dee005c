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
// it is larger than bend, and count 2^10 times: for a force that has grown since, and for an
// increment across the motion or in unknowns that move less than others.  Where each unknown is
// asked by itself a 16th of its rounding is what an increment may leave, measured or not: the bend
// of a linear oscillation, which leaves nothing, is counted as well.
//
// Note [what is below rounding]
// An increment below rounding ends an exact iteration.  Of an approximate one it leaves the
// contraction times itself: a hundredth of a rounding error, but the same way at every step.  Of
// Kepler's orbit (order 4, h = 0.1) the angular momentum fell by 1.6e-4 roundings a step.  Where
// that counts one more increment follows, which is made of rounding alone.
//
// Note [what every unknown lacks]
// Where a step moves by the gradient of the last iteration and H'' times the increment, what is of
// second order stays where it is: a bead at rest whose neighbour is hit was off by 57 roundings. Of
// each the next increment is taken to be the same part of the last one as of all together; `uneven`
// is the sum of what the increments are of their unknowns.  With an approximate matrix that would
// be wrong: an unknown that is small beside the others may contract far more slowly, and was off by
// 2e4 of its roundings.  `uneven` is then the sum of the increments beyond 8 roundings of their own
// unknowns, and none may be left, as long as they become smaller.
//
// Nor is it enough that an increment is lost in the rounding of its unknown: a coordinate that
// hardly moves is moved by a momentum of 1/h times its way, which is torn out of the equations and
// asked by nobody.  Of beads between walls, close to their turning points, momenta were off by 76
// of their roundings.  So 16 times the way that the step has moved it stands for its length where
// that is less (one rounding of the momentum then, of which 16 are allowed), and a 2^-20th of its
// length, for what never moves.
//
// Note [a prediction is followed while increments halve]
// They do where Newton and Kantorovich's theorem promises a solution, which then is not further
// away than twice the first.  A prediction that ends beyond a pole of the force wanders, and may
// come to another solution of the equations than the motion's: that is a failure, and the step is
// tried again from the state.
struct Motion {
  Real move = 0;
  Real bend = 0;
};
template <int Power>
struct NewtonRule {
  Real contraction = largest;
  int unchecked = 0;
  Real previous = 0;  // what the last increment was
  int grown = 0;
  bool predicted = false;
  Real far = 0;  // of an approximate matrix, what was uneven in the iteration before
  Motion motion;

  static constexpr Real tiny = 64 * epsilon / largest;  // next to the smallest number
  static Real power(Real size) { return Power == 2 ? size * size : size; }
  // From a prediction, or else from the state itself.
  void begin(bool from_prediction) {
    previous = 0;
    grown = 0;
    if (Power == 1) far = 0;
    predicted = from_prediction;
  }
  // The solution of a step, from the unknown `first` on, before the history records it.
  template <class Past, int Unknowns>
  void watch(const Past& past, const Real (&solution)[Unknowns], int first, int count) {
    motion.move = past.error(0, solution, first, count);
    motion.bend = past.error(Power + 1, solution, first, count);
  }
  // An increment as a part of what it must be lost in; nothing at the smallest numbers.  Of an
  // approximate matrix the increment, if it is not lost in the rounding of its unknown.
  static Real relative(Real moved, Real length, Real way) {
    if (Power == 1) return moved > 8 * epsilon * length + tiny ? moved : Real(0);
    return moved > tiny ? moved / felt(length, way) : Real(0);
  }
  // Of its length and its way in the step.
  static Real felt(Real length, Real way) {
    const Real least = 16 * way + length / 1048576;
    return Power == 2 && least < length ? least : length;
  }
  // Is even what all unknowns together move by lost in the rounding of one?  The least of them
  // answers for all: no more need be asked.
  bool is_lost_in(Real length, Real size) const {
    if (Power == 1) return size <= 8 * epsilon * length;
    const Real round_off = epsilon * length;
    const bool straight =
        previous > 0 || motion.bend * size * size * 16 <= round_off * power(motion.move);
    return straight && contraction * size * size * 16 <= round_off;
  }
  // By how much each unknown moves, the length that it is rounded with, and its way in the step, or
  // the lengths again where no way counts.
  Verdict of_each(const Real* moved, const Real* length, const Real* way, int count,
                  int iterations) {
    Real size = moved[0];
    Real scale = length[0];
    Real least = length[0];
    Real nearest = way[0];
    for (int j = 1; j < count; ++j) {
      size += moved[j];
      scale += length[j];
      least = length[j] < least ? length[j] : least;
      nearest = way[j] < nearest ? way[j] : nearest;
    }
    const Real shortest = way == length ? least : felt(least, nearest);
    const bool lost = is_lost_in(shortest, size);
    const Real uneven = lost ? Real(0) : relative(moved, length, way, count);
    return (*this)(size, scale, iterations, uneven);
  }
  static Real relative(const Real* moved, const Real* length, const Real* way, int count) {
    Real sum = 0;
    for (int j = 0; j < count; ++j) sum += relative(moved[j], length[j], way[j]);
    return sum;
  }
  // size, scale: sums over the unknowns of their increments and of their values; uneven: of what is
  // relative of them, where each counts.
  Verdict operator()(Real size, Real scale, int iterations, Real uneven = 0) {
    if (!(size <= largest)) {
      previous = size;
      return Verdict::failed;
    }
    const Real round_off = epsilon * scale;
    const bool waits = is_waited_for(uneven, round_off);
    if (previous > 0) {
      const Real seen = (size < round_off ? round_off : size) / power(previous);
      // It may rise at once but falls slowly: one small increment may be luck.
      const bool first = contraction >= largest;
      if (first || (size > 64 * round_off && seen > contraction)) {
        contraction = seen < largest ? seen : largest;
      } else if (seen < contraction) {
        contraction = 4 * seen < contraction ? contraction / 4 : seen;
      }
      unchecked = 0;
      // No progress twice in a row: this is round-off if it is small, else it may still recover.
      grown = size < previous ? 0 : grown + 1;
      if (grown >= 2 && size <= 4096 * round_off && !waits) return Verdict::done;
    } else {
      ++unchecked;
    }
    if (size <= round_off && is_chance(size, round_off) && !waits) return Verdict::done;
    const bool looked = previous > 0 || is_straight(size, round_off);
    const bool serves = Power == 1 ? !waits : uneven <= 0 || is_even(size * uneven);
    if (looked && serves && unchecked < 32 && contraction * power(size) * 1048576 <= round_off) {
      return Verdict::done;
    }
    const bool astray =
        predicted && iterations > 1 && 2 * size > previous && size > 4096 * round_off;
    previous = size;
    return iterations < 60 && !astray ? Verdict::go_on : Verdict::failed;
  }
  // Are there unknowns of which an approximate matrix leaves more than their rounding, and is there
  // more to be had?  See Note [what every unknown lacks].
  bool is_waited_for(Real uneven, Real round_off) {
    if (Power == 2) return false;
    const bool stays = far > 0 && 10 * uneven > 9 * far;
    far = uneven;
    return uneven > epsilon * epsilon * round_off && !stays;
  }
  // See Note [what is below rounding].
  bool is_chance(Real size, Real round_off) const {
    return Power == 2 || (previous > 0 && previous <= round_off) ||
           contraction * size * 8192 <= round_off;
  }
  // Is the next increment lost in the rounding of each unknown?  See Note [what every unknown
  // lacks].
  bool is_even(Real parts) const {
    const bool straight = previous > 0 || motion.bend * parts * 16 <= epsilon * power(motion.move);
    return straight && contraction * parts * 16 <= epsilon;
  }
  // Is bend (size / move)^Power lost in rounding?
  bool is_straight(Real size, Real round_off) const {
    const Real bend = motion.bend > size ? motion.bend : size;
    return bend * power(size) * 1024 <= round_off * power(motion.move);
  }
};
