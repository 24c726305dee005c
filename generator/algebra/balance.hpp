// A matrix in other units of its variables, by which rows and columns are of one size.
#pragma once

#include <vector>

namespace hamgen {

// Exponents e of D = diag(2^e) by which D^-1 M D has rows and columns of one size, in whatever
// units the variables of M, rows of a square, are (Parlett and Reinsch, Numer. Math. 13 (1969)
// 293): nothing is rounded by that, and without it eigenvalues are lost that are smaller than the
// rounding of the largest element.  All zero for a matrix that is not finite.
[[nodiscard]] std::vector<int> balance(std::vector<std::vector<double>> m);

}  // namespace hamgen
