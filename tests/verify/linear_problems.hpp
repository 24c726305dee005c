// Linear systems and schemes for them.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "generator/schemes/all_schemes.hpp"
#include "generator/schemes/read_gauge.hpp"
#include "generator/verify/linear_stability.hpp"
#include "generator/verify/linear_step.hpp"

namespace hamgen::linear_problems {

using Eigen::MatrixXd;

inline Expression exact(double value) { return Expression(from_double(value)); }
inline Expression h() { return Expression::symbol("h", kRankOfStep); }

inline Scheme member_of(int n, Expression alpha, Expression beta, Expression gamma) {
  return family_member(n, {{std::move(alpha)}}, {{std::move(beta)}}, {{std::move(gamma)}});
}

inline Scheme named(const std::string& name, int n) {
  Scheme scheme = *find_scheme(name);
  if (scheme.is_member()) {
    const auto [alpha, beta, gamma] = uniform_parameters(scheme.member()).value();
    return member_of(n, alpha, beta, gamma);
  }
  if (auto* composition = std::get_if<Composition>(&scheme.method))
    composition->base.degrees_of_freedom = n;
  return scheme;
}

inline QuadraticPart part_of(const MatrixXd& s) {
  return {static_cast<int>(s.rows() / 2), {s.data(), s.data() + s.size()}};
}

inline QuadraticPart oscillator(double w) { return {1, {w * w, 0, 0, 1}}; }

// Springs of different strength between different masses: V and T do not commute.
inline MatrixXd chain() {
  MatrixXd s = MatrixXd::Zero(6, 6);
  s.topLeftCorner(3, 3) << 3, -2, 0, -2, 7, -5, 0, -5, 6;
  s.bottomRightCorner(3, 3).diagonal() << 1, 0.5, 0.2;
  return s;
}

inline Expression decimal(const std::string& text) { return Expression(*parse_decimal(text)); }

inline GaugeBlock block(std::vector<Expression> entries) { return {std::move(entries)}; }

}  // namespace hamgen::linear_problems
