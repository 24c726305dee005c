// Equations with a proof that they have a solution: Krawczyk's interval Newton method.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/studies/ball.hpp"

namespace hamgen::app {

using BallVector = std::vector<Ball>;
using BallMatrix = std::map<std::pair<int, int>, Ball>;  // what is absent is 0

// F(x) = 0, and F'(x); where they are not defined everywhere in x, something is not finite.
struct BallEquations {
  std::function<BallVector(std::span<const Ball>)> residual;
  std::function<BallMatrix(std::span<const Ball>)> jacobian;
  // If the unknowns are states one after the other, of so many coordinates and as many momenta:
  // what is small among the ones need not be among the others, whose units are different.
  int degrees_of_freedom = 0;
  std::array<double, 2> largest = {};  // a coordinate and a momentum there have been before
};

struct BallSolution {
  BallVector x;         // one solution of the equations lies in here,
  double radius = 0.0;  // and no other one closer than this, relative to the size of the unknowns
  std::string failure;  // why nothing is proved; empty if all is
};

// Note [Krawczyk's test]
// With x the numbers found, X a box around them, and Y about F'(x)^-1, any numbers, the operator
//   K(X) = x - Y F(x) + (I - Y F'(X)) (X - x)
// maps X into its interior only if F has exactly one zero x* in X (Krawczyk 1969; Neumaier,
// Interval Methods for Systems of Equations, theorem 5.1.8).  For it x - x* = Y F(x) + (I - Y M) (x
// - x*) with M in F'(X), so that with G = |I - Y F'(X)|, q = its norm in the sizes w of the
// unknowns,
//   |x - x*| <= |Y F(x)| + G w |Y F(x)|_w / (1 - q).
//
// `from` is where Newton's iteration begins, in numbers; `must_contain`, if there are any, are
// numbers that the box has to reach, so that no second solution is nearer to them.  `radius` is
// tried first, then smaller ones.
[[nodiscard]] BallSolution solve_in_balls(const BallEquations& equations, const BallVector& from,
                                          bool must_contain, double radius);

}  // namespace hamgen::app
