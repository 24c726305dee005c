#include "app/studies/ball_jet.hpp"

#include <algorithm>
#include <array>

#include "app/studies/ball_expression.hpp"
#include "generator/algebra/derivative.hpp"
#include "generator/algebra/functions.hpp"

namespace hamgen::app {
namespace {

// f, f' and f'' at a ball.
struct Derivatives {
  Ball value, first, second;
};

// f(x), with the chain rule: f' dx, and f' ddx + f'' dx dx.
BallJet chain(const BallJet& x, const Derivatives& f) {
  BallJet result(f.value);
  result.second = x.second;
  for (const auto& [i, slope] : x.gradient) result.gradient.emplace(i, f.first * slope);
  if (!x.second) return result;
  for (const auto& [place, entry] : x.hessian) result.hessian.emplace(place, f.first * entry);
  if (f.second.is_zero()) return result;
  for (const auto& [i, slope] : x.gradient) {
    const Ball factor = f.second * slope;
    for (auto other = x.gradient.find(i); other != x.gradient.end(); ++other)
      result.hessian[{i, other->first}].add_product(factor, other->second);
  }
  return result;
}

template <class Map>
void add_scaled(Map& sum, const Map& terms, const Ball& factor) {
  for (const auto& [place, entry] : terms) sum[place].add_product(factor, entry);
}

BallJet linear(const BallJet& x, const Ball& a, const BallJet& y, const Ball& b) {
  BallJet result(a * x.value + b * y.value);
  result.second = x.second || y.second;
  add_scaled(result.gradient, x.gradient, a);
  add_scaled(result.gradient, y.gradient, b);
  add_scaled(result.hessian, x.hessian, a);
  add_scaled(result.hessian, y.hessian, b);
  return result;
}

Derivatives reciprocal(const Ball& x) {
  const Ball inverse = Ball(1) / x;
  const Ball square = inverse * inverse;
  return {inverse, -square, Ball(2) * inverse * square};
}

Ball value_of(std::string_view name, const Ball& x) { return Ball::function(name, {&x, 1}); }
Ball root(const Ball& x) { return value_of("sqrt", x); }

using Rule = Derivatives (*)(const Ball&);
struct NamedRule {
  std::string_view name;
  Rule rule;
};

// x/|x|, undefined where the ball reaches 0.
Derivatives of_abs(const Ball& x) {
  const Ball size = value_of("abs", x);
  return {size, x / size, Ball(0)};
}
// y' = s/r, y'' = s t x/r^3 with r = sqrt(1 - x^2), sqrt(1 + x^2), sqrt(x^2 - 1).
Derivatives of_root(std::string_view name, const Ball& x, const Ball& square, long s, long t) {
  const Ball r = root(square);
  const Ball first = Ball(s) / r;
  return {value_of(name, x), first, Ball(t) * first * x / square};
}
Derivatives of_acos(const Ball& x) { return of_root("acos", x, Ball(1) - x * x, -1, 1); }
Derivatives of_asin(const Ball& x) { return of_root("asin", x, Ball(1) - x * x, 1, 1); }
Derivatives of_acosh(const Ball& x) { return of_root("acosh", x, x * x - Ball(1), 1, -1); }
Derivatives of_asinh(const Ball& x) { return of_root("asinh", x, Ball(1) + x * x, 1, -1); }
// y' = 1/r, y'' = t 2 x/r^2.
Derivatives of_quotient(std::string_view name, const Ball& x, const Ball& r, long t) {
  const Ball first = Ball(1) / r;
  return {value_of(name, x), first, Ball(2 * t) * x * first * first};
}
Derivatives of_atan(const Ball& x) { return of_quotient("atan", x, Ball(1) + x * x, -1); }
Derivatives of_atanh(const Ball& x) { return of_quotient("atanh", x, Ball(1) - x * x, 1); }
Derivatives of_cos(const Ball& x) {
  const Ball value = value_of("cos", x);
  return {value, -value_of("sin", x), -value};
}
Derivatives of_sin(const Ball& x) {
  const Ball value = value_of("sin", x);
  return {value, value_of("cos", x), -value};
}
Derivatives of_cosh(const Ball& x) {
  const Ball value = value_of("cosh", x);
  return {value, value_of("sinh", x), value};
}
Derivatives of_sinh(const Ball& x) {
  const Ball value = value_of("sinh", x);
  return {value, value_of("cosh", x), value};
}
Derivatives of_exp(const Ball& x) {
  const Ball value = value_of("exp", x);
  return {value, value, value};
}
Derivatives of_log(const Ball& x) {
  const Ball inverse = Ball(1) / x;
  return {value_of("log", x), inverse, -inverse * inverse};
}
Derivatives of_sqrt(const Ball& x) {
  const Ball value = root(x);
  const Ball first = Ball(1) / (Ball(2) * value);
  return {value, first, -first / (Ball(2) * x)};
}
Derivatives of_tan(const Ball& x) {
  const Ball value = value_of("tan", x);
  const Ball first = Ball(1) + value * value;
  return {value, first, Ball(2) * value * first};
}
Derivatives of_tanh(const Ball& x) {
  const Ball value = value_of("tanh", x);
  const Ball first = Ball(1) - value * value;
  return {value, first, Ball(-2) * value * first};
}

constexpr std::array<NamedRule, 16> rules = {{{"abs", of_abs},
                                              {"acos", of_acos},
                                              {"acosh", of_acosh},
                                              {"asin", of_asin},
                                              {"asinh", of_asinh},
                                              {"atan", of_atan},
                                              {"atanh", of_atanh},
                                              {"cos", of_cos},
                                              {"cosh", of_cosh},
                                              {"exp", of_exp},
                                              {"log", of_log},
                                              {"sin", of_sin},
                                              {"sinh", of_sinh},
                                              {"sqrt", of_sqrt},
                                              {"tan", of_tan},
                                              {"tanh", of_tanh}}};

// The angle of (x, y): its differential is (x dy - y dx)/(x^2 + y^2), from which the second
// derivatives follow as those of products.  On the cut the value is any angle, as it is in H.
BallJet angle(const BallJet& y, const BallJet& x) {
  BallJet result(Ball::function("atan2", std::array{y.value, x.value}));
  result.second = x.second || y.second;
  const Ball square = x.value * x.value + y.value * y.value;
  const Ball by_y = x.value / square;
  const Ball by_x = -y.value / square;
  add_scaled(result.gradient, y.gradient, by_y);
  add_scaled(result.gradient, x.gradient, by_x);
  add_scaled(result.hessian, y.hessian, by_y);
  add_scaled(result.hessian, x.hessian, by_x);
  if (!result.second) return result;
  // f_yy = -2 x y/r^4 = -f_xx, f_xy = (y^2 - x^2)/r^4.
  const Ball fourth = square * square;
  const Ball by_yy = Ball(-2) * x.value * y.value / fourth;
  const Ball by_xy = (y.value * y.value - x.value * x.value) / fourth;
  const auto add = [&result](const std::map<int, Ball>& a, const std::map<int, Ball>& b,
                             const Ball& factor) {
    for (const auto& [i, first] : a) {
      for (const auto& [j, second] : b) {
        if (i <= j) result.hessian[{i, j}].add_product(factor * first, second);
      }
    }
  };
  add(y.gradient, y.gradient, by_yy);
  add(x.gradient, x.gradient, -by_yy);
  add(x.gradient, y.gradient, by_xy);
  add(y.gradient, x.gradient, by_xy);
  return result;
}

}  // namespace

BallJet operator+(const BallJet& x, const BallJet& y) { return linear(x, 1, y, 1); }
BallJet operator-(const BallJet& x, const BallJet& y) { return linear(x, 1, y, -1); }
BallJet operator-(const BallJet& x) { return linear(x, -1, BallJet(), 0); }

BallJet operator*(const BallJet& x, const BallJet& y) {
  BallJet result = linear(x, y.value, y, x.value);
  result.value = x.value * y.value;
  if (!result.second) return result;
  for (const auto& [i, first] : x.gradient) {
    for (const auto& [j, second] : y.gradient) {
      const std::pair<int, int> place = std::minmax(i, j);
      result.hessian[place].add_product(i == j ? Ball(2) * first : first, second);
    }
  }
  return result;
}

BallJet operator/(const BallJet& x, const BallJet& y) { return x * chain(y, reciprocal(y.value)); }

BallJet power(const BallJet& base, const BallJet& exponent) {
  const Ball& x = base.value;
  if (!exponent.is_constant()) {
    const std::array<BallJet, 1> logarithm = {exponent * chain(base, of_log(x))};
    return apply_function("exp", logarithm);
  }
  long n = 0;
  if (exponent.value.is_integer(n)) {
    if (n == 0) return BallJet(Ball(1));
    if (n == 1) return base;
    if (n == 2) return chain(base, {x * x, Ball(2) * x, Ball(2)});
    return chain(base, {x.power(n), Ball(n) * x.power(n - 1), Ball(n * (n - 1)) * x.power(n - 2)});
  }
  const Ball& e = exponent.value;
  const Ball less = e - Ball(1);
  return chain(base, {x.power(e), e * x.power(less), e * less * x.power(less - Ball(1))});
}

namespace {

// By the derivative that its row of the table says; not finite where that has none.
Derivatives by_table(std::string_view name, const Ball& x) {
  const Function* row = find_function(name);
  if (row == nullptr || row->slopes[0] == nullptr) return reciprocal(Ball(0));
  const Expression place = Expression::symbol("x");
  const Expression slope = row->slopes[0](std::span(&place, 1));
  const std::map<std::string, Ball> values = {{"x", x}};
  return {value_of(name, x), evaluate_in_balls(slope, values, x.bits()),
          evaluate_in_balls(derivative(slope, place), values, x.bits())};
}

}  // namespace

BallJet apply_function(std::string_view function, std::span<const BallJet> arguments) {
  if (function == "atan2") return angle(arguments[0], arguments[1]);
  for (const NamedRule& row : rules) {
    if (row.name != function) continue;
    return chain(arguments[0], row.rule(arguments[0].value));
  }
  return chain(arguments[0], by_table(function, arguments[0].value));
}

bool has_ball_derivatives(std::string_view function) {
  const Function* row = find_function(function);
  return function == "atan2" || (row != nullptr && row->by_others != nullptr) ||
         std::ranges::any_of(rules, [&](const NamedRule& rule) { return rule.name == function; });
}

}  // namespace hamgen::app
