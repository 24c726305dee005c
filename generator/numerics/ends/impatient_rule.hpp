// When to stop a fixed point that something else can take over from: as FixedPointRule, and with a
// failure where three times in a row it contracts by less than a half, or no longer gets nearer
// well above round-off.
struct ImpatientRule {
  FixedPointRule<2> rule;
  Real size = 0;  // of the last increment
  int slow = 0;

  void begin() {
    rule.begin();
    size = 0;
    slow = 0;
  }
  Verdict operator()(const Distance& moved, int iterations) {
    const Verdict verdict = rule.judge(moved, iterations);
    const bool comes_near = verdict == Verdict::go_on && rule.comes_near(moved);
    const bool visible = rule.size > 4096 * epsilon * moved.scale;
    slow = iterations > 1 && visible && 2 * rule.size > size ? slow + 1 : 0;
    size = rule.size;
    const bool near = rule.size <= 64 * moved.round_off();
    const bool gives_up = verdict == Verdict::done ? !near : slow >= 3;
    if (gives_up) return Verdict::failed;
    return comes_near ? Verdict::done : verdict;
  }
};
