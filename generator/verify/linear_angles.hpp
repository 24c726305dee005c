// How far the modes of a linear step turn, and where the fastest resonates.
#pragma once

#include <Eigen/Dense>
#include <map>
#include <optional>
#include <vector>

#include "generator/verify/linear_step.hpp"

namespace hamgen {

// The modes of a linear part, each a plane of its own: by ascending frequency.
class Modes {
 public:
  Modes(std::vector<Eigen::Matrix2d> planes, const LinearStep& step);
  [[nodiscard]] const std::vector<Eigen::Matrix2d>& planes() const { return planes_; }
  [[nodiscard]] double frequency(std::size_t k) const;
  [[nodiscard]] Eigen::Matrix2d matrix(std::size_t k, double h) const;
  // theta of the eigenvalues exp(+-i theta) of the matrix, without what it damps.
  [[nodiscard]] double angle(std::size_t k, double h) const;
  // By m = 3 to 6: the first h below `last` at which the fastest turns by 2 pi/m.
  [[nodiscard]] std::map<int, double> resonant_steps(double last) const;

 private:
  std::vector<Eigen::Matrix2d> planes_;
  const LinearStep& step_;
};

}  // namespace hamgen
