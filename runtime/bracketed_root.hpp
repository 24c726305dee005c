// A root between two values of different sign.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hamgen::runtime {

// Where f, whose values at a and b have different signs, changes its sign, to rounding of the
// argument: of the last two arguments that hold it the one with the smaller value.  R. P. Brent:
// Algorithms for Minimization without Derivatives (1973), chapter 4: the secant or an inverse
// parabola where they converge, else halving.
template <typename Function>
[[nodiscard]] double bracketed_root(const Function& f, double a, double fa, double b, double fb) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  double c = a;  // the root is between b, the best, and c; a is the one before b
  double fc = fa;
  double width = b - a;
  double before = width;
  for (int i = 0; i < 200 && fb != 0.0; ++i) {
    if ((fb > 0.0) == (fc > 0.0)) {
      c = a;
      fc = fa;
      width = before = b - a;
    }
    if (std::abs(fc) < std::abs(fb)) {
      a = std::exchange(b, c);
      c = a;
      fa = std::exchange(fb, fc);
      fc = fa;
    }
    const double tolerance = epsilon * std::abs(b);
    const double half = 0.5 * (c - b);
    if (std::abs(half) <= tolerance) break;
    if (std::abs(before) < tolerance || std::abs(fa) <= std::abs(fb)) {
      width = before = half;
    } else {
      const double s = fb / fa;
      double p = 2.0 * half * s;
      double q = 1.0 - s;
      if (a != c) {
        const double r = fb / fc;
        const double t = fa / fc;
        p = s * (2.0 * half * t * (t - r) - (b - a) * (r - 1.0));
        q = (t - 1.0) * (r - 1.0) * (s - 1.0);
      }
      if (p > 0.0) q = -q;
      p = std::abs(p);
      const double longest =
          std::min(3.0 * half * q - std::abs(tolerance * q), std::abs(before * q));
      before = 2.0 * p < longest ? width : half;
      width = 2.0 * p < longest ? p / q : half;
    }
    a = b;
    fa = fb;
    b += std::abs(width) > tolerance ? width : std::copysign(tolerance, half);
    fb = f(b);
  }
  return b;
}

}  // namespace hamgen::runtime
