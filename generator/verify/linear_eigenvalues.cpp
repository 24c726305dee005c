#include "generator/verify/linear_eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace hamgen {

std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
  return {values.begin(), values.end()};
}

double spectral_radius(const Eigen::MatrixXd& matrix) {
  double largest = 0.0;
  for (const std::complex<double>& value : eigenvalues(matrix))
    largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace hamgen
