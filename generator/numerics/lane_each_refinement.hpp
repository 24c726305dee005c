// The end of a fixed-point iteration, below the last place of its unknowns, in each lane as for one
// trajectory (refinement.hpp has the reasons).  A lane that wants no more has its rounded point
// again, and keeps what was found there.  In double one form of the equations is enough;
// where there are two its rounds go on for longer.
template <int Size, int Components, bool RoundsBeside = false, bool TwoForms = false>
struct Refinement {
  // A power of two near the third root of 1/epsilon.
  static constexpr double find_amplifier() {
    double power = 1;
    while (power * power * power * (8 * epsilon) < 1) power *= 2;
    return power;
  }
  static constexpr double amplifier = find_amplifier();
  static constexpr double tiny = 1 / largest;  // beside a unit that is nothing
  static constexpr double fewest = TwoForms ? 1024 : 32;
  Real change[Components] = {};  // of the gradient, from the rounded point to the solution
  Real slope[Components] = {};   // the gradient at the rounded point
  Real at[Size] = {};            // that point
  Real missing[Size] = {};       // by the equations there
  Real moved[Size] = {};         // the solution less the point
  Real ways[Size] = {};          // of each, from where a step began
  Real longest[Size] = {};       // of these
  Real spans[Size] = {};         // lengths of each, the largest of late
  Real shrinks[Size] = {};       // what a round leaves of each error, in the mean of some
  Real beside = 0;               // a length that an unknown is rounded with, where it RoundsBeside
  Real behind = 0;               // what small unknowns lacked when the point moved on for them
  Real last = 0;                 // what the last round moved all together
  Real begun = 0;                // the first of these
  Real least = 0;                // of these
  Real parts = 0;                // what the last round moved each, in its units, all together
  Real contraction = 1;          // what a round moved of what the one before did
  Real stuck = 0;                // rounds that moved no less
  Real untold = 48;              // steps since rounds have told how errors shrink
  Mask doubted = false;          // lanes where what is settled is not seen
  Mask foreseen = false;         // the last increment, as it stands in moved, missing and at
  bool went_ahead = false;       // has some lane?
  Mask open = false;             // lanes that want more
  Mask found = true;             // lanes where the solution was at the end
  Mask asks = false;             // lanes where it is asked how errors shrink
  Mask asked = false;            // lanes of which a rule wants to see two rounds more
  int rounds = 0;

  // Before the last increment is made in lanes of which a rule is not sure: of each unknown what it
  // is, what rounding takes from it, and how far the unknown has come in the step, or in the one
  // before.
  template <class Rule>
  void foresee(const Rule& rule, const Real* point, const Real* increment, const Real* from) {
    foreseen = rule.settled & !rule.sure;
    if (!any(foreseen)) return;
    for (int j = 0; j < Size; ++j) {
      const Real now = magnitude(point[j] - from[j]);
      const Real next = point[j] + increment[j];
      moved[j] = select(foreseen, increment[j] - (next - point[j]), moved[j]);
      missing[j] = select(foreseen, magnitude(increment[j]), missing[j]);
      at[j] = select(foreseen, select(now > ways[j], now, ways[j]), at[j]);
      ways[j] = select(foreseen, now, ways[j]);
    }
  }
  // Begins anew.
  void forget() {
    rounds = 0;
    contraction = 1;
    untold = 48;
    for (int j = 0; j < Size; ++j) ways[j] = longest[j] = spans[j] = shrinks[j] = 0;
  }
  // Where a rule has settled that nothing of it counts, and nothing is seen of it either, the
  // slopes are taken as they are; what else it finds of the contraction the rule gets to know.
  // In lanes where that is_slow then the solution has not been found.
  template <class Rule>
  bool operator()(const Turn& turn, Rule& rule, Real* point, const Real* lack,
                  const Real* gradient) {
    const int count = rounds;
    if (rounds == 0) {
      asked = rule.rounds_asked();
      rule.settled = turn.lanes & rule.settled;
      if (!went_ahead) {
        untold = select(turn.lanes & (untold < 48), untold + 1, untold);
        doubt(rule, point, lack);
      }
      went_ahead = goes_ahead(rule, point, lack);
      if (went_ahead) return true;
      begin(turn.lanes, point, lack, gradient);
      open = open & !rule.settled;
    }
    const Mask looked = open;
    if (count == 1) tell_how_they_shrink(lack);
    round(lack, gradient);
    if (count > 0)
      rule.learn_of_rounds(looked & (begun > 0), count, last / begun, Real(8 / amplifier));
    open = open & !rule.is_slow();
    return move(looked, point);
  }
  // lack: the next value less the point, or that multiplied by a matrix that contracts better. True
  // if it wants these and the gradient once more, in some lanes at points that it has moved.
  bool operator()(const Turn& turn, Real* point, const Real* lack, const Real* gradient) {
    if (rounds == 0) begin(turn.lanes, point, lack, gradient);
    const Mask looked = open;
    round(lack, gradient);
    return move(looked, point);
  }

 private:
  // What is settled, by what is seen, before any lane has gone ahead.
  template <class Rule>
  void doubt(const Rule& rule, const Real* point, const Real* lack) {
    doubted = rule.settled & !rule.sure;
    if (!any(doubted)) return;
    const Mask looks = foreseen & doubted;
    const Real left = sum_of(Size, [&](int j) {
      const Real follows = magnitude(lack[j] - moved[j]);
      const Real before = longest[j] * (Real(1023) / 1024);
      const Real now = select(ways[j] > before, ways[j], before);
      longest[j] = select(looks, now, longest[j]);
      const Real seen =
          select(follows > 4 * epsilon * at[j], follows * (follows / missing[j]), Real(0));
      const Mask grows = 32 * (now - before) > now;
      const Mask by_chance = missing[j] <= 2 * epsilon * length(point[j]);
      const Real told = select(grows | by_chance, Real(0), shrinks[j] * shrinks[j] * missing[j]);
      const Real part = select(seen > told, seen, told);
      const Real larger = select(follows > missing[j], follows, missing[j]);
      return select(16384 * part > epsilon * now, larger, Real(0));
    });
    const Mask lost =
        (left <= epsilon * epsilon * rule.round_off) & (Size == 1 ? Mask(true) : untold < 48);
    doubted = doubted & !(foreseen & lost);
    foreseen = false;
  }
  void tell_how_they_shrink(const Real* lack) {
    learn_how_they_shrink(open & ((asks & (untold >= 4)) | (untold >= 16)), lack);
    asks = asks & !open;
  }
  void learn_how_they_shrink(const Mask& lanes, const Real* lack) {
    if (!any(lanes)) return;
    for (int j = 0; j < Size; ++j) {
      const Real now = length(at[j]);
      const Real before = spans[j] * (Real(255) / 256);
      const Real span = select(now > before, now, before);
      spans[j] = select(lanes, span, spans[j]);
      const Real unit = epsilon * span / 4;
      const Real lacks = magnitude(missing[j]);
      const Real error = magnitude(missing[j] + (lack[j] - missing[j]) / amplifier);
      const Real seen = error / (select(lacks > unit, lacks, unit) + tiny);
      const Real part = select(seen < 1, seen, Real(1));
      const Real mean = select(shrinks[j] > 0, (3 * shrinks[j] + part) / 4, part);
      shrinks[j] = select(lanes, mean, shrinks[j]);
    }
    untold = select(lanes, Real(0), untold);
  }
  // As long as some small unknowns have not come to their end, all of that lane go on.
  template <class Rule>
  bool goes_ahead(Rule& rule, Real* point, const Real* lack) {
    const Mask seen = lacking(lack) > rule.round_off;
    const Real left = left_of(point, lack, select(seen, Real(64), Real(8)));
    const Mask waits = rule.settled & (left > epsilon * epsilon * rule.round_off);
    const Mask goes = waits & ((behind <= 0) | (2 * left < behind));
    const Mask stays = goes | !(waits | seen | doubted);
    asks = asks | (rule.settled & !stays);
    rule.settled = rule.settled & stays;
    behind = select(goes, left, Real(0));
    if (!any(goes)) return false;
    for (int j = 0; j < Size; ++j) point[j] = select(goes, point[j] + lack[j], point[j]);
    return true;
  }
  // Of which an unknown's rounding is a part.
  Real length(const Real& x) const {
    if constexpr (RoundsBeside) return magnitude(x) + beside;
    return magnitude(x);
  }
  // Of unknowns that lack more than so many units of their own rounding.
  Real left_of(const Real* point, const Real* lack, const Real& units) const {
    return sum_of(Size, [&](int j) {
      const Real lacks = magnitude(lack[j]);
      return select(lacks > units * epsilon * length(point[j]), lacks, Real(0));
    });
  }
  static Real lacking(const Real* lack) {
    return sum_of(Size, [&](int j) { return magnitude(lack[j]); });
  }
  void begin(const Mask& lanes, const Real* point, const Real* lack, const Real* gradient) {
    for (int j = 0; j < Size; ++j) {
      at[j] = select(lanes, point[j], at[j]);
      missing[j] = select(lanes, lack[j], missing[j]);
      moved[j] = select(lanes, Real(0), moved[j]);
    }
    for (int k = 0; k < Components; ++k) {
      slope[k] = select(lanes, gradient[k], slope[k]);
      change[k] = select(lanes, Real(0), change[k]);
    }
    open = lanes;
    found = found | lanes;
  }
  void round(const Real* lack, const Real* gradient) {
    if (!any(open)) return;
    const Mask lanes = open;
    Real lacking = 0;
    const Real part = 32768 * contraction;
    const Real counts = select(part > fewest, select(part < 8192, part, Real(8192)), Real(fewest));
    const Real size = sum_of(Size, [&](int j) {
      const Real error = missing[j] + (lack[j] - missing[j]) / amplifier;
      const Real way = moved[j] + error;
      moved[j] = way;
      const Real unit = epsilon * length(at[j]) + magnitude(way) / 128;
      lacking += select(magnitude(error) * counts > unit, magnitude(error), Real(0));
      return magnitude(error);
    });
    const Real units = sum_of(Size, [&](int j) {
      const Real error = missing[j] + (lack[j] - missing[j]) / amplifier;
      const Real unit = epsilon * length(at[j]) + magnitude(moved[j]) / 128;
      return magnitude(error) / (unit + tiny);
    });
    const Real seen = select(units < parts, units / parts, Real(1));
    parts = units;
    contraction = select(lanes & Mask(rounds > 0), seen, contraction);
    last = size;
    for (int k = 0; k < Components; ++k)
      change[k] = select(lanes, (gradient[k] - slope[k]) / amplifier, change[k]);
    // A slow contraction takes its time; what the rounding of the map leaves does not decrease.
    // What is lost beside the first round is not waited for.
    if (rounds == 0) begun = last;
    const Mask decreased = rounds == 0 ? Mask(true) : last < least;
    stuck = select(decreased, Real(0), stuck + 1);
    least = select(decreased, last, least);
    const Mask waits = open & (lacking > epsilon * epsilon * begun);
    const Mask goes_on = waits | (open & asked & Mask(rounds < 2));
    open = goes_on & (stuck < 4) & Mask(rounds < 500);
    const Mask ends = waits & !open;
    if (any(ends)) found = found & ((!ends) | (far_off(lack) <= 0));
  }
  // Of unknowns that a round still moves when no more is to be had.
  Real far_off(const Real* lack) const {
    return sum_of(Size, [&](int j) {
      const Real error = magnitude(missing[j] + (lack[j] - missing[j]) / amplifier);
      const Real unit = epsilon * length(at[j]);
      const Mask moves = (error * 32 > unit) & (error * 1024 > begun);
      return select(moves, error, Real(0));
    });
  }
  bool move(const Mask& looked, Real* point) {
    for (int j = 0; j < Size; ++j) {
      const Real ahead = at[j] + amplifier * moved[j];
      point[j] = select(open, ahead, select(looked, at[j], point[j]));
    }
    const bool more = any(open);
    rounds = more ? rounds + 1 : 0;
    return more;
  }
};
