// The gauge of a linear part: f(hA) for f(x) = 1/x - coth(x/2)/2, as a function of h.
#pragma once

#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

using RationalMatrix = std::vector<std::vector<Rational>>;

struct MatrixTerm {
  Expression function;  // of h, odd
  RationalMatrix matrix;
};

struct MatrixFunction {
  std::vector<MatrixTerm> terms;      // f(hA) is the sum of function * matrix
  std::vector<Rational> frequencies;  // w of the eigenvalues +-i w: f has poles at h w = 2 pi k
};

// For a Hamiltonian matrix A, to 50 digits.  With x = i y, f = i (cot(y/2)/2 - 1/y); f is odd and
// f(x) = -x/12 + x^3/720 - ..., so that f(hA) = hA g((hA)^2) and only A^2 has to be diagonalised:
// a free motion, for which A is nilpotent and A^2 = 0, is no exception.
// Throws UsageError if A^2 is neither nilpotent nor diagonalisable.
[[nodiscard]] MatrixFunction gauge_function(const RationalMatrix& a);

}  // namespace hamgen
