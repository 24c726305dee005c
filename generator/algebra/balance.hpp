// A matrix in other units of its variables, by which rows and columns are of one size.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hamgen {

// The sums of the absolute values of column and row i without the diagonal.
struct Beside {
  double column = 0.0, row = 0.0;
};
[[nodiscard]] Beside beside_diagonal(const Eigen::MatrixXd& m, Eigen::Index i);

// Exponents e of D = diag(2^e) by which D^-1 M D has rows and columns of one size, in whatever
// units the variables of M are (Parlett and Reinsch, Numer. Math. 13 (1969) 293); all zero for a
// matrix that is not finite.
[[nodiscard]] std::vector<int> balance(Eigen::MatrixXd m);

// D^-1 M D: nothing is rounded.  An eigenvalue of M that is smaller than the rounding of its
// largest element is lost without.
[[nodiscard]] Eigen::MatrixXd balanced(Eigen::MatrixXd m);

}  // namespace hamgen
