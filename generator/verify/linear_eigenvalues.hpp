// Eigenvalues of a real matrix in doubles, and how far a step's eigenvalues are from leaving the
// circle.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace hamgen {

// D^-1 M D of balance().
[[nodiscard]] Eigen::MatrixXd balanced(Eigen::MatrixXd m);
[[nodiscard]] std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd& matrix);
// The largest of the eigenvalues' absolute values.
[[nodiscard]] double spectral_radius(const Eigen::MatrixXd& matrix);

// Below zero, or not finite, where the powers of a 2 x 2 matrix are unbounded.
[[nodiscard]] double margin_of(const Eigen::MatrixXd& m, bool symplectic);
// The same for more degrees of freedom, and 0 where rounding hides the answer.  The eigenvalues
// lambda of a symplectic M are unimodular and semisimple if all lambda + 1/lambda, eigenvalues of
// M + M^-1 that are there twice, are real, different and between -2 and 2.  Free motions have 2.
[[nodiscard]] double margin_together(const Eigen::MatrixXd& matrix, int free_motions);

}  // namespace hamgen
