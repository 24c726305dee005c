// When to stop Newton's iteration with a matrix that serves over many iterations and steps, and
// when the matrix has served.
struct SimplifiedNewtonRule {
  FixedPointRule<1> rule;
  Real size = 0;  // of the last increment
  int age = 0;    // of the matrix, in iterations of this step

  void begin(bool factorised) {
    rule.begin();
    size = 0;
    age = factorised ? 1 : 0;
  }
  // residual: the sum of what the equations lacked before the increment.  Clears the flag where the
  // next iteration wants a matrix of its own.
  Verdict operator()(const Distance& moved, Real residual, bool& factorised, int iterations) {
    const Verdict verdict = rule.judge(moved, iterations);
    const bool comes_near = verdict == Verdict::go_on && rule.comes_near(moved);
    const Real before = size;
    size = rule.size;
    // Where the Hessian is huge the increments are small, far from any solution.
    const bool ends = verdict == Verdict::done || comes_near;
    if (ends && 16 * residual <= moved.scale) return Verdict::done;
    if (verdict != Verdict::go_on) {
      factorised = false;
      return Verdict::failed;
    }
    const bool visible = size > 4096 * epsilon * moved.scale;
    if (before > 0 && visible && 4 * size > before && age > 1) {
      factorised = false;
      age = 0;
    } else {
      ++age;
    }
    return Verdict::go_on;
  }
};
