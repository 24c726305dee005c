// When to stop Newton's iteration: at round-off.  Increments shrink as
//   next <= contraction * size^power,
// power = 2 with the exact matrix, 1 with an approximate one.  The contraction is measured, kept
// from step to step and checked at least every 32nd step; the motion of the step before says how
// curved the equations are.  Increments of several unknowns are added as parts of the sizes that
// these have had.  The rules and their reasons are those of newton_rule.hpp and
// newton_rule_of_many.hpp.
typedef enum { go_on, done, failed } Verdict;
typedef struct {
  int power;
  Real contraction;
  int unchecked;
  Real previous;
  int grown;
  bool predicted;
  Real move, bend;
  Real far;
  Real unit[3];   // one over the size of each of at most three unknowns; 0: not known yet
  Real moves[3];  // the motion of each, as it is written
  Real bends[3];
  Real before[3];  // by how much each moved in the iteration before
  int age;
  int fresh;  // steps until the motion is known
  bool still;
} NewtonRule;
static inline NewtonRule NewtonRule_of_power(int power) {
  NewtonRule rule = {0};
  rule.power = power;
  rule.contraction = largest;
  rule.unchecked = 32;
  rule.fresh = 4;
  return rule;
}
static inline Real NewtonRule_power(const NewtonRule* rule, Real size) {
  return rule->power == 2 ? size * size : size;
}
// From a prediction, or else from the state itself.
static inline void NewtonRule_begin(NewtonRule* rule, bool predicted) {
  rule->previous = 0;
  rule->grown = 0;
  rule->far = 0;
  rule->predicted = predicted;
}
static inline void NewtonRule_learn(NewtonRule* rule, Real size, Real round_off, bool doubtful) {
  const Real seen = (size < round_off ? round_off : size) / NewtonRule_power(rule, rule->previous);
  // It may rise at once but falls slowly: one small increment may be luck.
  const bool first = rule->contraction >= largest;
  if (first || (!doubtful && size > 64 * round_off && seen > rule->contraction)) {
    rule->contraction = seen < largest ? seen : largest;
  } else if (seen < rule->contraction) {
    rule->contraction = 4 * seen < rule->contraction ? rule->contraction / 4 : seen;
  }
}
// What the increment of an unknown must be lost in: the rounding of its length, or its way in the
// step.
static inline Real NewtonRule_felt(const NewtonRule* rule, Real length, Real way) {
  const Real least = 16 * way + epsilon * length;
  return rule->power == 2 && least < length ? least : length;
}
// Is what its own motion shows of each unknown lost?
static inline bool NewtonRule_is_in_reach(const NewtonRule* rule, const Real* moved,
                                          const Real* length, const Real* way, int count) {
  for (int j = 0; j < count && rule->power == 2; ++j) {
    const Real part = moved[j] * rule->unit[j];
    const Real move = rule->moves[j] * rule->unit[j];
    const Real shown = rule->bends[j] * rule->unit[j];
    const Real bend = shown > part ? shown : part;
    const Real round_off =
        epsilon * NewtonRule_felt(rule, magnitude(length[j]), way[j]) * rule->unit[j];
    if (bend <= 1024 * epsilon) continue;
    if (bend * part * part * 16384 > round_off * move * move) return false;
  }
  return true;
}
// Does none converge any more?
static inline bool NewtonRule_is_still(const NewtonRule* rule, const Real* moved,
                                       const Real* length, int count) {
  bool converging = false;
  for (int j = 0; j < count; ++j) {
    const bool moves = moved[j] > 8 * epsilon * magnitude(length[j]);
    converging = converging || (moves && 2 * moved[j] <= rule->before[j]);
  }
  return !converging;
}
// size, scale: of the increment and of the value, or sums over the unknowns; uneven: of what is
// relative of them; together, all: the sums of increments and of lengths, whatever their units;
// moved, length, way: of each of `many` unknowns.
static inline Verdict NewtonRule_judge(NewtonRule* rule, Real size, Real scale, int iterations,
                                       Real uneven, Real together, Real all, const Real* moved,
                                       const Real* length, const Real* way, int many) {
  rule->still = false;
  if (!(size <= largest)) {
    rule->previous = size;
    return failed;
  }
  const Real round_off = epsilon * scale;
  const bool stays = rule->far > 0 && 10 * uneven > 9 * rule->far;
  const bool waits = rule->power == 1 && uneven > epsilon * epsilon * round_off && !stays;
  rule->far = uneven;
  if (rule->previous > 0) {
    const Real least = rule->power == 2 ? 8 : 2;
    const bool slow = many ? least * size > rule->previous : size >= rule->previous;
    NewtonRule_learn(rule, size, round_off, many && slow);
    rule->unchecked = 0;
    // No progress twice in a row: this is round-off if it is small, else it may still recover.
    rule->grown = slow ? rule->grown + 1 : 0;
    const bool small = !many || 4096 * size <= scale;
    rule->still = rule->grown >= 2 && small && together <= 4096 * epsilon * all && !waits &&
                  NewtonRule_is_still(rule, moved, length, many);
    if (rule->still) return done;
  } else {
    ++rule->unchecked;
    rule->grown = 0;
  }
  // What an approximate matrix leaves is no chance where it is more than 2^-13 roundings.
  const bool chance = rule->power == 2 || (rule->previous > 0 && rule->previous <= round_off) ||
                      rule->contraction * size * 8192 <= round_off;
  const Real parts = size * uneven;
  const Real bend = rule->bend > size ? rule->bend : size;
  const bool bends = bend * parts * 16384 > epsilon * NewtonRule_power(rule, rule->move);
  const bool even = rule->previous > 0 ? uneven * 16384 <= epsilon
                                       : !bends && rule->contraction * parts * 16384 <= epsilon;
  const bool in_reach =
      rule->previous > 0 || NewtonRule_is_in_reach(rule, moved, length, way, many);
  const bool serves = in_reach && (rule->power == 1 ? !waits : uneven <= 0 || even);
  if (size <= round_off && chance && (serves || stays)) return done;
  // What the motion shows must be lost in this: of a single unknown, in 1024 times its way.
  const Real near = 1024 * rule->move + round_off;
  const Real shown = many ? 8 * round_off : epsilon * (near < scale ? near : scale);
  const bool straight =
      bend * NewtonRule_power(rule, size) * 1048576 <= shown * NewtonRule_power(rule, rule->move);
  const bool reaches =
      !many || rule->previous <= 0 || rule->power == 1 || size * size * size <= epsilon * round_off;
  if ((rule->previous > 0 || straight) && serves && reaches && rule->unchecked < 32 &&
      rule->contraction * NewtonRule_power(rule, size) * 1048576 <= round_off) {
    return done;
  }
  const bool astray = rule->predicted && iterations > 1 && 2 * size > rule->previous &&
                      together > 4096 * epsilon * all;
  rule->previous = size;
  if (many && iterations >= 60 && together <= 64 * epsilon * all) return done;
  return iterations < 60 && !astray ? go_on : failed;
}
// An increment as a part of that, or what the next one is of it; of an approximate matrix the
// increment, if it is not lost in the rounding of its unknown.
static inline Real NewtonRule_relative(const NewtonRule* rule, int j, Real moved, Real length,
                                       Real way) {
  const Real tiny = 64 * epsilon / largest;
  if (rule->power == 1) return moved > 8 * epsilon * length + tiny ? moved : 0;
  if (!(moved > tiny)) return 0;
  if (rule->previous <= 0) return moved / NewtonRule_felt(rule, length, way);
  if (moved * rule->unit[j] <= 64 * epsilon) return 0;
  if (rule->fresh > 0) return moved / NewtonRule_felt(rule, length, way);
  const Real ratio = moved / rule->before[j];
  return moved / NewtonRule_felt(rule, length, way) * ratio * ratio;
}
// Is even what all unknowns together move by lost in the rounding of one?
static inline bool NewtonRule_is_lost_in(const NewtonRule* rule, Real length, Real size) {
  if (rule->power == 1) return size <= 8 * epsilon * length;
  const Real round_off = epsilon * length;
  const Real bend = rule->bend > size ? rule->bend : size;
  const bool straight =
      rule->previous <= 0 && bend * size * size * 16384 <= round_off * rule->move * rule->move;
  return straight && rule->contraction * size * size * 16384 <= round_off;
}
static inline Real NewtonRule_size_of(Real length, Real moved) {
  const Real value = magnitude(length);
  const Real by = magnitude(moved);
  return value + 32 * (value > 0 && value < by ? value : by);
}
// The sizes of unknowns from a first iteration.
static inline void NewtonRule_know(NewtonRule* rule, const Real* length, const Real* moved,
                                   int count) {
  const Real smallest = 1 / largest / (epsilon * epsilon * epsilon);
  if (rule->unit[0] > 0) return;
  Real total = 0;
  for (int j = 0; j < count; ++j) total += NewtonRule_size_of(length[j], moved[j]);
  if (!(total > 0 && total <= largest)) return;
  for (int j = 0; j < count; ++j) {
    const Real size = NewtonRule_size_of(length[j], moved[j]) + total / 1099511627776;
    rule->unit[j] = 1 / (size + smallest);
  }
}
// What the unknowns of a step have come to.
static inline void NewtonRule_follow(NewtonRule* rule, const Real* value, int count) {
  if (++rule->age < 16) return;
  rule->age = 0;
  Real least = rule->unit[0];
  for (int j = 1; j < count; ++j) least = rule->unit[j] < least ? rule->unit[j] : least;
  for (int j = 0; j < count; ++j) {
    const Real part = magnitude(value[j]) * rule->unit[j];
    const bool falls = part > 0 && 1024 * part < 1 && rule->unit[j] < 1099511627776 * least;
    if (part <= 2 && !falls) continue;
    rule->unit[j] = falls ? 32 * rule->unit[j] : 1 / magnitude(value[j]);
    rule->unchecked = 32;
  }
}
// By how much each unknown moves, the length that it is rounded with, and its way in the step, or
// the lengths again where no way counts.
static inline Verdict NewtonRule_of_each(NewtonRule* rule, const Real* moved, const Real* length,
                                         const Real* way, int count, int iterations) {
  NewtonRule_know(rule, length, moved, count);
  Real size = moved[0] * rule->unit[0];
  Real least = length[0] * rule->unit[0];
  Real nearest = way[0] * rule->unit[0];
  for (int j = 1; j < count; ++j) {
    size += moved[j] * rule->unit[j];
    const Real part = length[j] * rule->unit[j];
    least = part < least ? part : least;
    const Real gone = way[j] * rule->unit[j];
    nearest = gone < nearest ? gone : nearest;
  }
  const Real shortest = way == length ? least : NewtonRule_felt(rule, least, nearest);
  Real uneven = 0;
  if (!NewtonRule_is_lost_in(rule, shortest, size)) {
    for (int j = 0; j < count; ++j) {
      const Real part = NewtonRule_relative(rule, j, moved[j], length[j], way[j]);
      uneven += part * (rule->power == 1 ? rule->unit[j] : 1);
    }
  }
  Real together = moved[0];
  Real scale = length[0];
  for (int j = 1; j < count; ++j) {
    together += moved[j];
    scale += length[j];
  }
  const Verdict verdict = NewtonRule_judge(rule, size, (Real)count, iterations, uneven, together,
                                           scale, moved, length, way, count);
  // Noise of rounding is no more than 64 roundings of a size: what an iteration has ended with.
  for (int j = 0; rule->still && j < count; ++j) {
    if (moved[j] * rule->unit[j] > 64 * epsilon) {
      rule->unit[j] = 64 * epsilon / moved[j];
    }
  }
  for (int j = 0; verdict == go_on && j < count; ++j) rule->before[j] = moved[j];
  return verdict;
}
// Of a single unknown.
static inline Verdict NewtonRule_check(NewtonRule* rule, Real size, Real scale, int iterations) {
  return NewtonRule_judge(rule, size, scale, iterations, 0, size, scale, &size, &scale, &scale, 0);
}
