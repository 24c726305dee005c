// Where f, whose values at a and b have different signs, changes its sign, to rounding of the
// argument: of the last two arguments that hold it the one with the smaller value.  R. P. Brent:
// Algorithms for Minimization without Derivatives (1973), chapter 4: the secant or an inverse
// parabola where they converge, else halving.
template <class Function>
Real bracketed_root(const Function& f, Real a, Real fa, Real b, Real fb) {
  Real c = a;  // the root is between b, the best, and c; a is the one before b
  Real fc = fa;
  Real width = b - a;
  Real before = width;
  for (int i = 0; i < 200 && fb != 0; ++i) {
    if ((fb > 0) == (fc > 0)) {
      c = a;
      fc = fa;
      width = before = b - a;
    }
    if (magnitude(fc) < magnitude(fb)) {
      a = b;
      b = c;
      c = a;
      fa = fb;
      fb = fc;
      fc = fa;
    }
    const Real tolerance = epsilon * magnitude(b);
    const Real half = (c - b) / 2;
    if (magnitude(half) <= tolerance) break;
    if (magnitude(before) < tolerance || magnitude(fa) <= magnitude(fb)) {
      width = before = half;
    } else {
      const Real s = fb / fa;
      Real p = 2 * half * s;
      Real q = 1 - s;
      if (a != c) {
        const Real r = fb / fc;
        const Real t = fa / fc;
        p = s * (2 * half * t * (t - r) - (b - a) * (r - 1));
        q = (t - 1) * (r - 1) * (s - 1);
      }
      if (p > 0) q = -q;
      p = magnitude(p);
      const Real inside = 3 * half * q - magnitude(tolerance * q);
      const Real halving = magnitude(before * q);
      const bool converges = 2 * p < (inside < halving ? inside : halving);
      before = converges ? width : half;
      width = converges ? p / q : half;
    }
    a = b;
    fa = fb;
    if (magnitude(width) > tolerance) {
      b += width;
    } else {
      b += half < 0 ? -tolerance : tolerance;
    }
    fb = f(b);
  }
  return b;
}
