// For which h do the powers of a linear step stay bounded?
#pragma once

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "generator/verify/rational_step.hpp"

namespace hamgen {

// h > 0.
struct StableSteps {
  // Ascending; in between they are unbounded, or it is not known.  The last may end at infinity.
  std::vector<std::pair<double, double>> intervals;
  // Inside of them: eigenvalues meet or reach +-1 at these single h, and are bounded on both sides.
  std::vector<double> borders;
  // As far as was looked; infinity where every h was.
  double looked_to = std::numeric_limits<double>::infinity();
  bool exact = true;  // no rounding decided

  [[nodiscard]] bool is_every_h() const;
  // From where the first begins at 0; empty if it does not, or does not end.
  [[nodiscard]] std::optional<double> first_end() const;
  // Between the first and the last.
  [[nodiscard]] std::vector<std::pair<double, double>> gaps() const;
};

// Of a system of up to three degrees of freedom.  The coefficients of q(s), s = x + 1/x, are
// polynomials in h after its denominator.  Where no root of its leading coefficient, of q(2), q(-2)
// and of the discriminant lies between two h, both have as many eigenvalues on the unit circle: one
// h decides for each of the finitely many intervals.  Empty where C is no rational function of h,
// or the polynomials are too long.  Nothing is drawn from a grid; roots closer than 1e-14 count as
// one.
[[nodiscard]] std::optional<StableSteps> stable_steps(const RationalStep& step,
                                                      const ExactMatrix& s, int free_motions);
// The same of one degree of freedom with an explicit Runge-Kutta method, which does not keep areas:
// det M <= 1.
[[nodiscard]] std::optional<StableSteps> damped_steps(const RationalStep& step,
                                                      const ExactMatrix& s);

// In the units of another frequency: all h divided by w.
[[nodiscard]] StableSteps divided_by(StableSteps steps, double w);
[[nodiscard]] StableSteps intersection(const StableSteps& a, const StableSteps& b);

}  // namespace hamgen
