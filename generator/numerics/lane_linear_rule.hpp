// When to stop solving linear equations in each lane: as the rule of one trajectory does
// (linear_rule.hpp has the reason).
struct LinearRule : Iteration {
  static constexpr double small_part = [] {
    double part = 1;
    while (part * part > epsilon) part /= 2;
    return part;
  }();
  // The numbers are those that the rule of one trajectory is given.  Gives the lanes that move.
  Mask operator()(const Real& size, const Real& scale, int iterations) {
    taken = select(open, Real(iterations), taken);
    end_with(open & !(size <= largest), size);
    open = open & !(size <= small_part * scale);
    if (iterations >= 60) end_with(open, size);
    return open;
  }
};
