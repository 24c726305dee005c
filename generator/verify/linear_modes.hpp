// A linear Hamiltonian system taken apart into oscillations of one degree of freedom.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "generator/schemes/scheme.hpp"
#include "generator/verify/exact_matrix.hpp"

namespace hamgen {

// The squares of the eigenvalues of A = J S come in pairs; one of each.
struct LinearSpectrum {
  std::vector<double> frequencies;  // ascending
  int free_motions = 0;
  int growing = 0;
  bool resonant = false;  // a double frequency with a Jordan block of A
  double growth_rate = 0.0;
  double largest = 0.0;  // of the absolute values of eigenvalues of A
};
[[nodiscard]] LinearSpectrum linear_spectrum(const Eigen::MatrixXd& s);
// The same in rationals: counts and Jordan blocks are exact, and a growth however slow is one.
[[nodiscard]] LinearSpectrum exact_spectrum(const ExactMatrix& s);

// Systems S_k, 2 x 2, each an invariant plane of the flow and of the scheme's step; empty if no
// such planes are known.  With S = [[V, 0], [0, T]]:
//   a tableau steps with a function of A: any plane of an oscillation is one;
//   a splitting, and a member with the same alpha for all and no beta or gamma, look the same in
//     the coordinates L q, L^-T p, and with L T L^T = I the planes are those of L^-T V L^-1;
//   with the same beta and gamma for all, L must be orthogonal: V and T have to commute.
[[nodiscard]] std::optional<std::vector<Eigen::Matrix2d>> linear_modes(const Eigen::MatrixXd& s,
                                                                       const Scheme& scheme);
// The scheme for one degree of freedom; empty for a member without parameters for all.
[[nodiscard]] std::optional<Scheme> scheme_of_one(const Scheme& scheme);

}  // namespace hamgen
