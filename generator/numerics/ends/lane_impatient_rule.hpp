// When to stop a fixed point in each lane that something else can take over from: as the rule of
// one trajectory does (impatient_rule.hpp).
struct ImpatientRule : FixedPointRule<2> {
  Real slow = 0;

  void begin(const Turn& turn) {
    FixedPointRule<2>::begin(turn);
    slow = 0;
  }
  Mask operator()(const Distance& moved, int iterations) {
    Judgement judgement = judge(moved, iterations);
    const Mask ends = comes_near(moved);
    const Real round_off = epsilon * moved.scale;
    const Mask drags = Mask(iterations > 1) & (size > 4096 * round_off) & (2 * size > before);
    slow = select(drags, slow + 1, Real(0));
    const Mask near = size <= 64 * moved.round_off();
    judgement.failed =
        judgement.failed | (judgement.done & !near) | ((slow >= 3) & !judgement.done);
    judgement.done = judgement.done | (ends & !judgement.failed);
    return end(judgement);
  }
};
