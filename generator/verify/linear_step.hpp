// What a scheme makes of a linear system z' = J S z: one step is z -> M z.
#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>
#include <vector>

#include "generator/schemes/scheme.hpp"
#include "generator/verify/precise.hpp"

namespace hamgen {

// J S for a symmetric S, 2n x 2n.
[[nodiscard]] Eigen::MatrixXd linear_flow(const Eigen::MatrixXd& s);

class LinearStep {
 public:
  // `values` are those of the parameters and E0 that the scheme's coefficients use.
  LinearStep(Scheme scheme, std::map<std::string, Precise> values);

  [[nodiscard]] const Scheme& scheme() const { return scheme_; }

  // M, 2n x 2n.  Not finite where the equations of the step have no solution, or C a pole.
  //   member      (I - X (I/2 + C))^-1 (I + X (I/2 - C)),   X = h J S; at order R, see below
  //   tableau     I + (b^T x hA) (I - a x hA)^-1 (1 x I),   A = J S
  //   splitting   the product of its drifts [[I, a h S_pp], [0, I]] and kicks [[I, 0], [-b h S_qq,
  //               I]]
  [[nodiscard]] Eigen::MatrixXd matrix(double h, const Eigen::MatrixXd& s) const;

  // The matrix of the iteration that solves the step, zbar <- z + (I/2 + C) X zbar or, of a
  // tableau, the stages' a x hA; of a composition that of the largest.  Empty for explicit schemes.
  [[nodiscard]] Eigen::MatrixXd iteration(double h, const Eigen::MatrixXd& s) const;

  // C of the member at this h.
  [[nodiscard]] Eigen::MatrixXd gauge(const Member& member, double h) const;

 private:
  // h J S_K of the K that stands in for H at order R.  The exact flow E = exp(hA) is the step with
  //   X = (E - I) ((I/2 + C) E + I/2 - C)^-1 = hA + O(h^2),
  // and K is that cut off after h^R.
  [[nodiscard]] Eigen::MatrixXd increment(const Member& member, double h,
                                          const Eigen::MatrixXd& s) const;
  [[nodiscard]] Eigen::MatrixXd member_matrix(const Member& member, double h,
                                              const Eigen::MatrixXd& s) const;
  [[nodiscard]] Eigen::MatrixXd splitting_matrix(double h, const Eigen::MatrixXd& s) const;
  [[nodiscard]] Eigen::MatrixXd tableau_matrix(const Eigen::MatrixXd& ha) const;

  Scheme scheme_;
  std::map<std::string, Precise> values_;
  // The coefficients of the scheme, rounded.
  std::vector<double> kicks_, drifts_, substeps_;
  Eigen::MatrixXd a_;
  Eigen::VectorXd b_;
};

}  // namespace hamgen
