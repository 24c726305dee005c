// A value with its gradient and Hessian, in balls, as sparse as the expression: what forward
// differentiation makes of a model, without anybody's derivative.
#pragma once

#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "app/studies/ball.hpp"

namespace hamgen::app {

struct BallJet {
  Ball value;
  std::map<int, Ball> gradient;                 // what is absent is 0
  std::map<std::pair<int, int>, Ball> hessian;  // of i <= j; only if `second`
  bool second = false;

  BallJet() = default;
  explicit BallJet(Ball constant) : value(std::move(constant)) {}
  // Variable i.
  BallJet(Ball at, int i, bool with_second) : value(std::move(at)), second(with_second) {
    gradient.emplace(i, Ball(1));
  }
  [[nodiscard]] bool is_constant() const { return gradient.empty(); }
};

[[nodiscard]] BallJet operator+(const BallJet& x, const BallJet& y);
[[nodiscard]] BallJet operator-(const BallJet& x, const BallJet& y);
[[nodiscard]] BallJet operator*(const BallJet& x, const BallJet& y);
[[nodiscard]] BallJet operator/(const BallJet& x, const BallJet& y);
[[nodiscard]] BallJet operator-(const BallJet& x);
[[nodiscard]] BallJet power(const BallJet& base, const BallJet& exponent);
// A function of the language; its value or a derivative is not finite where it is not defined, and
// for a name that has no derivatives here (see has_ball_derivatives).
[[nodiscard]] BallJet apply_function(std::string_view function, std::span<const BallJet> arguments);
[[nodiscard]] bool has_ball_derivatives(std::string_view function);

}  // namespace hamgen::app
