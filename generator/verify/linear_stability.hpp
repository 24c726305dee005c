// Near a point the step is a linear map: do its powers stay bounded, and up to which h?
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/verify/precise.hpp"
#include "generator/verify/proof.hpp"
#include "generator/verify/stable_steps.hpp"

namespace hamgen {

// H = ... + (z - z0)^T S (z - z0)/2: S row by row, 2n x 2n.
struct QuadraticPart {
  int degrees_of_freedom = 0;
  std::vector<Rational> hessian;
  bool exact = true;  // its entries are no rounded numbers
};

// The flow z' = A z with A = J S, its oscillations exp(+-i w t) and the scheme's step z -> M z.
struct LinearStability {
  double h = 0.0;
  std::vector<double> frequencies;  // w, ascending
  int free_motions = 0;             // degrees of freedom with w = 0
  int growing = 0;                  // degrees of freedom that leave exponentially
  bool resonant = false;            // a double frequency with a Jordan block: growth like t
  double growth_rate = 0.0;         // the largest real part of an eigenvalue of A

  // Are the powers of M bounded on the oscillations?
  Verdict verdict = Verdict::not_decided;
  std::string detail;  // how it was decided, or why not
  // Positive where bounded: a distance of trace M from -2 and 2, or of an eigenvalue from 1.
  std::optional<double> margin;
  bool bounded_for_every_h = false;
  // For which h > 0 they are, from-to; the last may end at infinity.  Empty where that is not
  // known, and where the step is unbounded at this h.
  bool searched = false;
  std::vector<std::pair<double, double>> bounded_steps;
  std::vector<double> borders;  // single h in between at which they may not be
  double looked_to = std::numeric_limits<double>::infinity();
  // The end of the first of them, where it begins at 0.
  std::optional<double> largest_h;

  // theta of the eigenvalues exp(+-i theta) of M, in the order of the frequencies; empty where M is
  // unbounded or not taken apart into modes.
  std::vector<double> angles;
  // By m = 3 to 6: the first h, below largest_h, at which the fastest turns by 2 pi/m a step.
  std::map<int, double> resonant_h;

  // Spectral radius of the iteration zbar <- z + h (I/2 + C) J S zbar: it contracts below 1. Empty
  // for explicit schemes.
  std::optional<double> iteration_radius;
};

// A member (alpha, beta, gamma) of the family on H = p^2/2 + omega^2 q^2/2: the powers of its
// matrix are bounded iff this is positive.  With X = (1 + h beta)(1 - h omega^2 gamma) and D = X +
// h^2 omega^2 alpha (1 - alpha) it is the smaller of D and X - h^2 omega^2 (alpha - 1/2)^2.
[[nodiscard]] double linear_margin(double h, double omega_squared, double alpha, double beta,
                                   double gamma);

// `values` are those of the parameters, and of E0, that the scheme's coefficients use.  By
// structure first: a method that is a function of hJS needs the spectrum alone, one that looks the
// same in every mode one stability function of h w.  Else parts of up to three degrees of freedom
// in exact rationals (stable_steps.hpp).  `proved` where S, C, the scheme's coefficients and h are
// exact.
[[nodiscard]] LinearStability linear_stability(const QuadraticPart& part, const Scheme& scheme,
                                               const std::map<std::string, Rational>& values,
                                               const Rational& h);

// At one point of the phase space.
struct LinearPoint {
  std::string place;  // "initial state", "origin"
  LinearStability stability;
};
// At the state in `point`, and at the origin if that is an equilibrium with another linear part.
// `point` has the values of all variables and parameters.
[[nodiscard]] std::vector<LinearPoint> linear_points(const Mechanics& mechanics,
                                                     const Scheme& scheme,
                                                     const std::map<std::string, Rational>& point,
                                                     const Rational& h);

// Its lines of a proof: the flow, the bound, resonances, the iteration.
[[nodiscard]] Proof findings(const LinearPoint& point);

}  // namespace hamgen
