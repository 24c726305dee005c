// When to stop Newton's iteration: at round-off.  Increments shrink as
//   next <= contraction * size^power,
// power = 2 with the exact matrix, 1 with an approximate one.  The contraction is measured, kept
// from step to step and checked at least every 32nd step; the motion of the step before says how
// curved the equations are.  The rule and its reasons are those of newton_rule.hpp.
typedef enum { go_on, done, failed } Verdict;
typedef struct {
  int power;
  Real contraction;
  int unchecked;
  Real previous;
  int grown;
  bool predicted;
  Real move, bend;
} NewtonRule;
static inline NewtonRule NewtonRule_of_power(int power) {
  const NewtonRule rule = {power, largest, 0, 0, 0, false, 0, 0};
  return rule;
}
static inline Real NewtonRule_power(const NewtonRule* rule, Real size) {
  return rule->power == 2 ? size * size : size;
}
// From a prediction, or else from the state itself.
static inline void NewtonRule_begin(NewtonRule* rule, bool predicted) {
  rule->previous = 0;
  rule->grown = 0;
  rule->predicted = predicted;
}
// size, scale: sums over the unknowns, of their increments and of their values.
static inline Verdict NewtonRule_check(NewtonRule* rule, Real size, Real scale, int iterations) {
  if (!(size <= largest)) return failed;
  const Real round_off = epsilon * scale;
  if (rule->previous > 0) {
    const Real seen =
        (size < round_off ? round_off : size) / NewtonRule_power(rule, rule->previous);
    // It may rise at once but falls slowly: one small increment may be luck.
    const bool first = rule->contraction >= largest;
    if (first || (size > 64 * round_off && seen > rule->contraction)) {
      rule->contraction = seen < largest ? seen : largest;
    } else if (seen < rule->contraction) {
      rule->contraction = 4 * seen < rule->contraction ? rule->contraction / 4 : seen;
    }
    rule->unchecked = 0;
    // No progress twice in a row: this is round-off if it is small, else it may still recover.
    rule->grown = size < rule->previous ? 0 : rule->grown + 1;
    if (rule->grown >= 2 && size <= 4096 * round_off) return done;
  } else {
    ++rule->unchecked;
  }
  // What an approximate matrix leaves is no chance where it is more than 2^-13 roundings.
  const bool chance = rule->power == 2 || (rule->previous > 0 && rule->previous <= round_off) ||
                      rule->contraction * size * 8192 <= round_off;
  if (size <= round_off && chance) return done;
  const Real bend = rule->bend > size ? rule->bend : size;
  const bool straight =
      bend * NewtonRule_power(rule, size) * 1024 <= round_off * NewtonRule_power(rule, rule->move);
  if ((rule->previous > 0 || straight) && rule->unchecked < 32 &&
      rule->contraction * NewtonRule_power(rule, size) * 1048576 <= round_off) {
    return done;
  }
  const bool astray =
      rule->predicted && iterations > 1 && 2 * size > rule->previous && size > 4096 * round_off;
  rule->previous = size;
  return iterations < 60 && !astray ? go_on : failed;
}
