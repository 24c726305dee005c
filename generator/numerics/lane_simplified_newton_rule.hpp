// When to stop Newton's iteration in each lane with a matrix that serves over many iterations and
// steps, and when the matrix has served: as for one trajectory (simplified_newton_rule.hpp).
struct SimplifiedNewtonRule : FixedPointRule<1> {
  Real age = 0;  // of the matrix, in iterations of this step

  void begin(const Turn& turn, const Mask& factorised) {
    FixedPointRule<1>::begin(turn);
    size = 0;
    age = select(factorised, Real(1), Real(0));
  }
  // residual: the sum of what the equations lacked before the increment.  Clears the flag where the
  // next iteration wants a matrix of its own.
  Mask operator()(const Distance& moved, const Real& residual, Mask& factorised, int iterations) {
    Judgement judgement = judge(moved, iterations);
    // Where the Hessian is huge the increments are small, far from any solution.
    const Mask solves = 16 * residual <= moved.scale;
    const Mask ends = comes_near(moved) & solves & !judgement.done;
    judgement.failed = judgement.failed | (judgement.done & !solves);
    judgement.done = (judgement.done | ends) & !judgement.failed;
    const Mask visible = size > 4096 * epsilon * moved.scale;
    const Mask served = (before > 0) & visible & (4 * size > before) & (age > 1);
    factorised = factorised & !(open & (judgement.failed | (served & !judgement.done)));
    age = select(served, Real(0), age + 1);
    return end(judgement);
  }
};
