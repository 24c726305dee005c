// When to stop solving linear equations for what they lack, which is known far below rounding: an
// increment brings rounding errors that are a part of itself, and once it is below the root of a
// rounding error they are lost.
struct LinearRule {
  static constexpr Real small_part = [] {
    Real part = 1;
    while (part * part > epsilon) part /= 2;
    return part;
  }();
  // size, scale: sums over the unknowns of their increments and of their values.
  Verdict operator()(Real size, Real scale, int iterations) const {
    if (!(size <= largest)) return Verdict::failed;
    if (size <= small_part * scale) return Verdict::done;
    return iterations < 60 ? Verdict::go_on : Verdict::failed;
  }
};
