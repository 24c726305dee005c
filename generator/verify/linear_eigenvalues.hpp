// Eigenvalues of a real matrix.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace hamgen {

[[nodiscard]] std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd& matrix);
// The largest of their absolute values.
[[nodiscard]] double spectral_radius(const Eigen::MatrixXd& matrix);

}  // namespace hamgen
