// The end of a fixed-point iteration, below the last place of its unknowns.  Of the points that its
// rounded map takes to themselves it ends at one on the side it came from, and at one where the
// rounding of the map lets it: at every step alike, a bias and no chance.  So it goes on from any
// point close by, some ten units of rounding from the solution.  What the equations lack there is
// small, and known without an error.  Over that distance they are linear, and their change along it
// is found by a difference over one `amplifier` times as long: what is not linear, and what a
// difference loses, are both far below a unit of rounding.
//
// Note [what a round leaves]
// The last round's increment is seen by nobody: the slopes are those before it.  By it they, and
// the step, are off as much as the next round would move, the contraction times that, and what is
// cut off is a bias: a 2^-13th of a unit.  The contraction is that of two rounds, of this step or
// of the one before, in units of each unknown, four times over: beside others 1e6 times as large,
// by lengths, two at walls lost 4e-4 of a rounding a step.  No more than a 32nd of a unit is left.
// Where stages are those of coordinates alone it is a 1024th: momenta, which are no unknowns then,
// are moved by 1/h times as much.  With a 32nd gauss-4 gained 4e-4 roundings of its energy a step
// between walls exp(40 (q - 1)).  (In float it is a 32nd: a difference there knows no more.)
//
// Note [two forms of the equations]
// Stages of coordinates alone have another form in rounds than that by which they first lack
// something, with rounded coefficients of its own: at the same point it differs by units of its
// terms, of which there is left what the amplifier divides them by.  In double that is nothing; in
// float it is a 128th, the same way at every step: the energy of an oscillator at h omega = 130
// grew by 4e-2 units a step.  There the second form is looked at where the first one was, too.
//
// Note [what is left behind]
// What a rule leaves of an unknown in every step, a 2^-14th of the rounding of its way, adds up to
// less than its walk at random.  What follows an increment shows how it shrinks, but no nearer than
// some roundings of its way, and behind those a pendulum, which left a hundredth of itself beside
// what was louder and shrank to a 1e4th, lost 2e-3 roundings a step.  So it is asked what a round
// of refinement leaves of each error, in every 48th step at least.  Its way is the longest of late:
// where an unknown turns back its energy is what it was.  One whose way grows by a 32nd in a step,
// as ahead of a wave, has little of an energy yet, and an increment of a rounding or two has its
// sign by chance: these are not asked.
//
template <int Size, int Components, bool RoundsBeside = false, bool TwoForms = false>
struct Refinement {
  // A power of two near the third root of 1/epsilon.
  static constexpr Real find_amplifier() {
    Real power = 1;
    while (power * power * power * (8 * epsilon) < 1) power *= 2;
    return power;
  }
  static constexpr Real amplifier = find_amplifier();
  static constexpr Real tiny = 1 / largest;  // beside a unit that is nothing
  static constexpr Real fewest = TwoForms && amplifier > 4096 ? 1024 : 32;
  static constexpr int size = Size;
  static constexpr int components = Components;
  static constexpr bool rounds_beside = RoundsBeside;
  static constexpr bool looks_twice = TwoForms && amplifier < 4096;
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
  int stuck = 0;                 // rounds that moved no less
  int rounds = 0;
  int asked = 0;    // rounds that a rule wants to see behind the first
  int untold = 48;  // steps since rounds have told how errors shrink
  bool changes = false;
  bool foreseen = false;  // the last increment, as it stands in moved, missing and at
  bool doubted = false;   // what a rule has settled, by what was seen
  bool looks = false;     // at what the other form lacks there
  bool asks = false;      // how errors shrink?
  Real lacked[looks_twice ? Size : 1] = {};
  Real sloped[looks_twice ? Components : 1] = {};  // the gradient with it
  bool found = true;  // was the solution at the end, or does the map not contract?

  // Before the last increment is made of a rule that is not sure: of each unknown what it is, what
  // rounding takes from it, and how far the unknown has come in the step, or in the one before:
  // where it turns back, two terms of its way cancel, and what they are rounded by is seen in
  // either.
  template <class Rule>
  void foresee(const Rule& rule, const Real* point, const Real* increment, const Real* from) {
    if (rule.sure || !rule.settled) return;
    for (int j = 0; j < Size; ++j) {
      const Real now = magnitude(point[j] - from[j]);
      const Real next = point[j] + increment[j];
      moved[j] = increment[j] - (next - point[j]);
      missing[j] = magnitude(increment[j]);
      at[j] = now > ways[j] ? now : ways[j];
      ways[j] = now;
    }
    foreseen = true;
  }
  // Where a rule has settled that nothing of it counts, and nothing is seen of it either, the
  // slopes are taken as they are; what else it finds of the contraction the rule gets to know.
  // Where that is_slow then the solution has not been found: it is left to the solver behind.
  // Unknowns that are small beside the others count for nothing in a rule's sums: as long as some
  // of them have not come to their end, or are too far from it for a difference, all go on.  What
  // was doubted then is so still, for nothing is seen of what is left behind that.
  template <class Rule>
  bool operator()(Rule& rule, Real* point, const Real* lack, const Real* gradient) {
    if (rounds == 0 && behind <= 0 && untold < 48) ++untold;
    if (rule.settled) {
      const Real little = epsilon * epsilon * rule.round_off;
      if (behind <= 0) doubted = !rule.sure && !is_believed(point, lack, little);
      foreseen = false;
      const bool seen = lacking(lack) > rule.round_off;
      const Real open = left(point, lack, seen ? 64 : 8);
      const bool waits = open > little;
      const bool ends = !seen && !waits && !doubted;
      const bool goes_ahead = waits && (behind <= 0 || 2 * open < behind);
      behind = goes_ahead ? open : 0;
      if (goes_ahead) {
        for (int j = 0; j < Size; ++j) point[j] += lack[j];
        return true;
      }
      if (ends) {
        ++rule.unchecked;
        found = true;
        take_slopes(gradient);
        if (changes) forget_changes();
        return false;
      }
      asks = true;
    }
    rule.settled = false;
    const int count = rounds;
    if (count == 0) asked = rule.rounds_asked();
    if (count == 1) tell_how_they_shrink(lack);
    const bool more = (*this)(point, lack, gradient);
    if (count > 0 && begun > 0) rule.learn_of_rounds(count, last / begun, 8 / amplifier);
    if (!more || !rule.is_slow()) return more;
    rounds = 0;
    for (int j = 0; j < Size; ++j) point[j] = at[j];
    return false;
  }
  // lack: the next value less the point, or that multiplied by a matrix that contracts better. True
  // if it wants these and the gradient once more, at the point it has moved; else that is the
  // rounded one again.
  bool operator()(Real* point, const Real* lack, const Real* gradient) {
    if (rounds == 0 && !looks) begin(point, lack, gradient);
    if constexpr (looks_twice) {
      if (rounds == 0) {
        looks = !looks;
        if (looks) return true;
        keep(lack, gradient);
      }
    }
    Real error[Size] = {};
    for (int j = 0; j < Size; ++j) {
      error[j] = error_of(j, lack);
      moved[j] += error[j];
    }
    // See Note [what a round leaves].
    const Real counts = times_counted();
    const Real open = sum_of<Size>([&](int j) {
      const Real unit = epsilon * length(at[j]) + magnitude(moved[j]) / 128;
      return magnitude(error[j]) * counts > unit ? magnitude(error[j]) : Real(0);
    });
    learn_of(lengths_of(error), sum_of<Size>([&](int j) {
               const Real unit = epsilon * length(at[j]) + magnitude(moved[j]) / 128;
               return magnitude(error[j]) / (unit + tiny);
             }));
    for (int k = 0; k < Components; ++k) change[k] = off(k, gradient) / amplifier;
    changes = true;
    const bool more = goes_on(open, lack);
    for (int j = 0; j < Size; ++j) point[j] = more ? at[j] + amplifier * moved[j] : at[j];
    return more;
  }

  // Begins anew.
  void forget() {
    rounds = 0;
    contraction = 1;
    untold = 48;
    for (int j = 0; j < Size; ++j) ways[j] = longest[j] = spans[j] = shrinks[j] = 0;
  }
  bool is_believed(const Real* point, const Real* lack, Real little) {
    return foreseen && not_lost_behind(point, lack) <= little && knows_how_they_shrink();
  }
  // Of the increments, where what is left behind counts: what follows is seen from some roundings
  // of a way on, which are those of the equations, and that again in the same ratio is left; or as
  // much as errors shrink.  See Note [what is left behind].
  Real not_lost_behind(const Real* point, const Real* lack) {
    for (int j = 0; j < Size; ++j) {
      const Real follows = magnitude(lack[j] - moved[j]);
      const Real before = longest[j] * (Real(1023) / 1024);
      longest[j] = ways[j] > before ? ways[j] : before;
      const bool grows = 32 * (longest[j] - before) > longest[j];
      const bool by_chance = missing[j] <= 2 * epsilon * length(point[j]);
      const Real seen = follows > 4 * epsilon * at[j] ? follows * (follows / missing[j]) : Real(0);
      const Real told = grows || by_chance ? Real(0) : shrinks[j] * shrinks[j] * missing[j];
      const Real left = seen > told ? seen : told;
      const Real larger = follows > missing[j] ? follows : missing[j];
      moved[j] = 16384 * left > epsilon * longest[j] ? larger : Real(0);
    }
    return lengths_of(moved);
  }
  // A single one is told by the rule itself.
  bool knows_how_they_shrink() const { return Size == 1 || untold < 48; }
  void tell_how_they_shrink(const Real* lack) {
    if (untold >= (asks ? 4 : 16)) learn_how_they_shrink(lack);
    asks = false;
  }
  // By the first round behind the rounded point, of the errors that this leaves: a rough pattern,
  // which shrinks less than a smooth one.
  void learn_how_they_shrink(const Real* lack) {
    for (int j = 0; j < Size; ++j) {
      const Real now = length(at[j]);
      const Real before = spans[j] * (Real(255) / 256);
      spans[j] = now > before ? now : before;
      const Real unit = epsilon * spans[j] / 4;
      const Real lacks = magnitude(missing[j]);
      const Real seen = magnitude(error_of(j, lack)) / ((lacks > unit ? lacks : unit) + tiny);
      const Real left = seen < 1 ? seen : Real(1);
      shrinks[j] = shrinks[j] > 0 ? (3 * shrinks[j] + left) / 4 : left;
    }
    untold = 0;
  }
  void forget_changes() {
    changes = false;
    for (Real& value : change) value = 0;
  }
  Real times_counted() const {
    const Real left = 32768 * contraction;
    return left > fewest ? (left < 8192 ? left : Real(8192)) : fewest;
  }
  void learn_of(Real length, Real units) {
    if (rounds > 0) contraction = units < parts ? units / parts : Real(1);
    parts = units;
    last = length;
  }
  void begin(const Real* point, const Real* lack, const Real* gradient) {
    for (int j = 0; j < Size; ++j) {
      at[j] = point[j];
      missing[j] = lack[j];
      moved[j] = 0;
    }
    take_slopes(gradient);
  }
  // See Note [two forms of the equations].
  void keep(const Real* lack, const Real* gradient) {
    for (int j = 0; j < Size; ++j) lacked[j] = lack[j];
    for (int k = 0; k < Components; ++k) sloped[k] = gradient[k];
  }
  // What the equations lack where the solution is taken to be.
  Real error_of(int j, const Real* lack) const {
    if constexpr (looks_twice) return missing[j] + (lack[j] - lacked[j]) / amplifier;
    return missing[j] + (lack[j] - missing[j]) / amplifier;
  }
  // How far the gradient is from that at the rounded point.
  Real off(int k, const Real* gradient) const {
    if constexpr (looks_twice) return gradient[k] - sloped[k];
    return gradient[k] - slope[k];
  }
  void take_slopes(const Real* gradient) {
    for (int k = 0; k < Components; ++k) slope[k] = gradient[k];
  }
  // Of which an unknown's rounding is a part.
  Real length(Real x) const {
    if constexpr (RoundsBeside) return magnitude(x) + beside;
    return magnitude(x);
  }
  // Of unknowns that lack more than so many units of their own rounding.
  Real left(const Real* point, const Real* lack, Real units) const {
    return sum_of<Size>([&](int j) {
      const Real lacks = magnitude(lack[j]);
      return lacks > units * epsilon * length(point[j]) ? lacks : Real(0);
    });
  }
  static Real lacking(const Real* lack) {
    return sum_of<Size>([&](int j) { return magnitude(lack[j]); });
  }
  // A slow contraction takes its time; what the rounding of the map leaves does not decrease.  What
  // is lost beside the first round is not waited for (Distance).
  bool goes_on(Real open, const Real* lack) {
    if (rounds == 0) begun = last;
    stuck = rounds == 0 || last < least ? 0 : stuck + 1;
    if (stuck == 0) least = last;
    const bool waits = open > epsilon * epsilon * begun;
    const bool more = (waits || rounds < asked) && stuck < 4 && rounds < 500;
    rounds = more ? rounds + 1 : 0;
    found = !waits || more || far_off(lack) <= 0;
    return more;
  }
  // Of unknowns that a round still moves by more than a 32nd of a unit, when no more is to be had,
  // and by a part of what the first one did that rounding does not leave.  A row of some eight
  // terms, each of the size of the largest unknown, is rounded by as many of its units, and a
  // difference over the amplifier by that part of them.  In double that is below a 2^-14th of a
  // unit, and the part of the first round answers for it; in float it is a 16th: an unknown that is
  // near zero for a moment could not be told from what does not converge, and steps that were
  // solved failed.
  Real far_off(const Real* lack) const {
    Real noise = 0;
    for (int j = 0; j < Size && amplifier < 4096; ++j) {
      const Real left = 8 * epsilon * magnitude(at[j]) / amplifier;
      noise = left > noise ? left : noise;
    }
    return sum_of<Size>([&](int j) {
      const Real error = magnitude(error_of(j, lack));
      const Real unit = epsilon * length(at[j]);
      const bool moves = error * 32 > unit && error * 1024 > begun;
      return moves && error > noise ? error : Real(0);
    });
  }
};
