#include "generator/verify/linear_angles.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace hamgen {

using Eigen::Matrix2d;

namespace {

// The first h, upwards in steps of 2 %, at which the function is below zero.
std::optional<double> first_below_zero(const std::function<double(double)>& function, double low,
                                       double high) {
  constexpr double ratio = 1.02;
  if (function(low) < 0.0) return low;
  for (double here = low; here * ratio <= high; here *= ratio) {
    if (function(here * ratio) >= 0.0) continue;
    double good = here;
    double bad = here * ratio;
    for (int halving = 0; halving < 60 && bad - good > 1e-14 * bad; ++halving) {
      const double middle = 0.5 * (good + bad);
      (function(middle) < 0.0 ? bad : good) = middle;
    }
    return bad;
  }
  return std::nullopt;
}

}  // namespace

Modes::Modes(std::vector<Matrix2d> planes, const LinearStep& step)
    : planes_(std::move(planes)), step_(step) {
  std::ranges::sort(planes_, {}, [](const Matrix2d& s) { return s.determinant(); });
}

double Modes::frequency(std::size_t k) const { return std::sqrt(planes_[k].determinant()); }

Matrix2d Modes::matrix(std::size_t k, double h) const { return step_.matrix(h, planes_[k]); }

// 2 - trace = det(M - I) = 4 sin^2(theta/2) keeps its digits.
double Modes::angle(std::size_t k, double h) const {
  Matrix2d m = matrix(k, h);
  m /= std::sqrt(std::abs(m.determinant()));
  const double minus = (m(0, 0) - 1.0) * (m(1, 1) - 1.0) - m(0, 1) * m(1, 0);
  const double plus = 2.0 + m.trace();
  return 2.0 * std::atan2(std::sqrt(std::max(minus, 0.0)), std::sqrt(std::max(plus, 0.0)));
}

std::map<int, double> Modes::resonant_steps(double last) const {
  const std::size_t fastest = planes_.size() - 1;
  std::map<int, double> result;
  for (const int m : {3, 4, 5, 6}) {
    const double goal = 2.0 * std::numbers::pi / m;
    const auto missing = [&](double h) { return goal - angle(fastest, h); };
    const auto h = first_below_zero(missing, 1e-3 / frequency(fastest), last);
    if (h) result.emplace(m, *h);
  }
  return result;
}

}  // namespace hamgen
