// Where an expression is defined but not smooth.
#pragma once

#include <string>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

struct Corner {
  Expression function;  // abs(q - 1), sqrt(q^2), atan2(q, p)
  std::string place;    // "q - 1 = 0"
};

// The absolute values, the odd powers of roots of squares, and the cuts of atan2 in it: what a
// derivative knows nothing of.  Each once, in the order of the expression.  A root of a base that
// is no square ends the domain where the base vanishes, and is no corner.
[[nodiscard]] std::vector<Corner> corners(const Expression& e);
[[nodiscard]] std::vector<Corner> corners(const std::vector<Expression>& expressions);
// Of H; where sums stay loops, of their summands.
[[nodiscard]] std::vector<Corner> corners_of_hamiltonian(const Mechanics& mechanics);

// "off the corners of abs(q) and sqrt(p^2)"; empty if there are none.
[[nodiscard]] std::string off_the(const std::vector<Corner>& corners);

}  // namespace hamgen
