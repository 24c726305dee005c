#include "generator/algebra/functions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "generator/algebra/derivative.hpp"
#include "generator/algebra/evaluate.hpp"

namespace hamgen {
namespace {

TEST(Functions, are_in_alphabetical_order) {
  EXPECT_TRUE(std::ranges::is_sorted(all_functions(), {}, &Function::name));
}

// The two agree to the last bit or two of the library, and in where they are defined.
TEST(Functions, have_the_values_of_the_library_where_it_has_any) {
  for (const Function& function : all_functions()) {
    if (function.arity != 1) continue;
    for (const double x : {-40.0, -3.5, -1.0, -0.75, 0.0, 1e-9, 0.3, 1.0, 2.0, 100.0, 1e15}) {
      const Rational argument = from_double(x);
      const auto value = evaluate_function(function.name, std::span(&argument, 1));
      const double expected = function.numbers.real(x, 0);
      const bool grows = std::isinf(expected) && function.domain == "all x";
      EXPECT_TRUE(grows || value.has_value() == std::isfinite(expected)) << function.name << x;
      if (value && std::isfinite(expected)) {
        EXPECT_NEAR(to_double(*value), expected, 4e-16 * std::abs(expected)) << function.name << x;
      }
    }
  }
}

// One place where each is defined: 1.5 where acosh begins, else 0.3.
std::vector<Rational> inside(const Function& function) {
  if (function.arity == 2) return {Rational(3, 10), Rational(-7, 10)};
  return {function.name == "acosh" ? Rational(3, 2) : Rational(3, 10)};
}

double real_value(const Function& function, const std::vector<double>& x) {
  return function.numbers.real(x[0], x.back());
}

TEST(Functions, have_one_value_in_every_scalar) {
  for (const Function& function : all_functions()) {
    const std::vector<Rational> x = inside(function);
    const Rational exact = *evaluate_function(function.name, x);
    const double near = to_double(exact);
    const double first = to_double(x.front());
    const double last = to_double(x.back());
    EXPECT_NEAR(function.numbers.real(first, last), near, 4e-16) << function.name;
    EXPECT_NEAR(function.numbers.single(float(first), float(last)), near, 4e-7) << function.name;
    const auto extended = [](const Rational& q) {
      const double high = to_double(q);
      return static_cast<long double>(high) + to_double(q - from_double(high));
    };
    const long double wide = function.numbers.extended(extended(x.front()), extended(x.back()));
    EXPECT_NEAR(double(wide - static_cast<long double>(near)), to_double(exact - from_double(near)),
                1e-18)
        << function.name;
  }
}

// By differences, and as GiNaC differentiates.
TEST(Functions, have_the_slopes_of_their_values) {
  const std::vector<Expression> symbols = {Expression::symbol("x", 0), Expression::symbol("y", 1)};
  for (const Function& function : all_functions()) {
    const auto arity = static_cast<std::size_t>(function.arity);
    const std::vector<Rational> x = inside(function);
    std::map<std::string, Rational> point;
    std::vector<Expression> arguments;
    for (std::size_t i = 0; i < arity; ++i) {
      point[symbols[i].name()] = x[i];
      arguments.push_back(symbols[i]);
    }
    for (std::size_t i = 0; i < arity; ++i) {
      ASSERT_NE(function.slopes[i], nullptr) << function.name;
      const auto slope = evaluate(function.slopes[i](arguments), point);
      ASSERT_TRUE(slope) << function.name;
      std::vector<double> up{to_double(x.front()), to_double(x.back())};
      std::vector<double> down = up;
      constexpr double d = 1e-5;
      up[i] += d;
      down[i] -= d;
      const double measured = (real_value(function, up) - real_value(function, down)) / (2 * d);
      EXPECT_NEAR(to_double(*slope), measured, 1e-8) << function.name << i;
      const Expression call = Expression::apply(std::string(function.name), arguments);
      const auto derived = evaluate(derivative(call, symbols[i]), point);
      EXPECT_EQ(to_double(*slope), to_double(*derived)) << function.name << i;
    }
  }
}

TEST(Functions, have_the_parity_and_the_shape_of_their_rows) {
  for (const Function& function : all_functions()) {
    if (function.arity != 1) continue;
    const auto at = [&](double x) { return function.numbers.real(x, 0.0); };
    bool odd = true;
    bool even = true;
    bool ascends = true;
    bool descends = true;
    for (int k = -80; k <= 80; ++k) {
      const double x = k / 16.0;
      if (std::isnan(at(x)) || std::isinf(at(x))) continue;
      odd = odd && at(-x) == -at(x);
      even = even && at(-x) == at(x);
      const double next = at(x + 1.0 / 16.0);
      if (std::isnan(next)) continue;
      ascends = ascends && next >= at(x);
      descends = descends && next <= at(x);
    }
    const Parity parity = odd ? Parity::odd : even ? Parity::even : Parity::none;
    EXPECT_EQ(parity, function.parity) << function.name;
    EXPECT_EQ(ascends, function.shape == Shape::ascending) << function.name;
    EXPECT_EQ(descends, function.shape == Shape::descending) << function.name;
    EXPECT_EQ(even, function.shape == Shape::valley_at_zero || function.shape == Shape::cosine)
        << function.name;
  }
}

TEST(Functions, are_rational_where_their_rows_say_so) {
  for (const Function& function : all_functions()) {
    if (!function.exact_at) continue;
    const Rational x(*function.exact_at);
    const auto value = evaluate_function(function.name, std::span(&x, 1));
    ASSERT_TRUE(value) << function.name;
    EXPECT_EQ(value->get_den(), 1) << function.name;
  }
}

TEST(Functions, whose_squares_have_a_partner_have_that_one) {
  for (const Function& function : all_functions()) {
    if (function.square_partner.empty()) continue;
    const double f = function.numbers.real(0.7, 0.0);
    const double g = find_function(function.square_partner)->numbers.real(0.7, 0.0);
    EXPECT_NEAR(f * f, function.square_sign * (1 - g * g), 1e-15) << function.name;
  }
}

// exp(x) - 1 has the digits of x, not those that 1 leaves of them.
TEST(Functions, have_their_digits_near_zero) {
  const Rational x = *parse_decimal("1e-45");
  for (const auto& [name, sign] : {std::pair("expm1", 1), {"log1p", -1}}) {
    const auto value = evaluate_function(name, std::span(&x, 1));
    ASSERT_TRUE(value) << name;
    EXPECT_LT(abs(*value / x - 1 - sign * x / 2), *parse_decimal("1e-55")) << name;
    EXPECT_NE(*value, x) << name;
  }
}

TEST(Functions, are_exact_where_the_value_is_rational) {
  const auto value = [](const char* name, Rational x) {
    return evaluate_function(name, std::span(&x, 1));
  };
  EXPECT_EQ(value("sqrt", Rational(9, 4)), Rational(3, 2));
  EXPECT_EQ(value("sin", 0), Rational(0));
  EXPECT_EQ(value("cos", 0), Rational(1));
  EXPECT_EQ(value("exp", 0), Rational(1));
  EXPECT_EQ(value("log", 1), Rational(0));
  EXPECT_EQ(value("acos", 1), Rational(0));
  EXPECT_EQ(value("abs", Rational(-1, 3)), Rational(1, 3));
}

TEST(Functions, are_exact_at_multiples_of_pi) {
  const Rational pi = evaluate_function("pi", {}).value();
  const auto value = [&pi](const char* name, const Rational& multiple) {
    const Rational x = multiple * pi;
    return evaluate_function(name, std::span(&x, 1));
  };
  EXPECT_EQ(value("sin", 1), Rational(0));
  EXPECT_EQ(value("sin", -1000001), Rational(0));
  EXPECT_EQ(value("sin", Rational(5, 6)), Rational(1, 2));
  EXPECT_EQ(value("cos", Rational(1, 2)), Rational(0));
  EXPECT_EQ(value("cos", Rational(4, 3)), Rational(-1, 2));
  EXPECT_EQ(value("tan", Rational(-3, 4)), Rational(1));
  EXPECT_FALSE(value("tan", Rational(1, 2)));
  // Others are what they were.
  EXPECT_DOUBLE_EQ(to_double(value("sin", Rational(1, 7)).value()), std::sin(std::acos(-1.0) / 7));
  EXPECT_DOUBLE_EQ(to_double(value("exp", 1).value()), std::exp(std::acos(-1.0)));
  EXPECT_DOUBLE_EQ(to_double(value("log", Rational(1, 2)).value()), std::log(std::acos(-1.0) / 2));
}

TEST(Functions, atan2_knows_its_quadrant_and_refuses_the_origin) {
  const auto angle = [](Rational y, Rational x) {
    const std::vector<Rational> arguments = {y, x};
    return evaluate_function("atan2", arguments);
  };
  EXPECT_DOUBLE_EQ(to_double(angle(1, -1).value()), std::atan2(1.0, -1.0));
  EXPECT_DOUBLE_EQ(to_double(angle(-1, -2).value()), std::atan2(-1.0, -2.0));
  EXPECT_FALSE(angle(0, 0));
}

// sin(10^22) is a classical test of argument reduction.
TEST(Functions, periodic_functions_keep_their_digits_at_large_arguments) {
  const Rational x = parse_decimal("1e22").value();
  EXPECT_EQ(to_double(evaluate_function("sin", std::span(&x, 1)).value()),
            -0.8522008497671888017727);
}

// sin(n + 1/3) = sin(n) cos(1/3) + cos(n) sin(1/3), where n alone has more than 60 digits.
TEST(Functions, periodic_functions_see_the_fraction_behind_a_long_integer) {
  const auto value = [](const char* name, const Rational& x) {
    return evaluate_function(name, std::span(&x, 1)).value();
  };
  const Rational n = parse_decimal("1e80").value();
  const Rational third(1, 3);
  const Rational sum =
      value("sin", n) * value("cos", third) + value("cos", n) * value("sin", third);
  EXPECT_LT(abs(value("sin", n + third) - sum), parse_decimal("1e-55").value());
}

// The first 50 digits of pi, and of the square root of 2.
TEST(Functions, constants_have_fifty_digits) {
  const Rational tiny = parse_decimal("1e-49").value();
  const Rational pi = parse_decimal("3.14159265358979323846264338327950288419716939937511").value();
  EXPECT_LT(abs(evaluate_function("pi", {}).value() - pi), tiny);
  const Rational root =
      parse_decimal("1.41421356237309504880168872420969807856967187537695").value();
  EXPECT_LT(abs(evaluate_power(2, Rational(1, 2)).value() - root), tiny);
}

TEST(Powers, exist_where_they_are_real) {
  EXPECT_EQ(evaluate_power(Rational(2, 3), -2), Rational(9, 4));
  EXPECT_EQ(evaluate_power(0, Rational(1, 2)), Rational(0));
  EXPECT_FALSE(evaluate_power(0, 0));
  EXPECT_FALSE(evaluate_power(0, -1));
  EXPECT_FALSE(evaluate_power(-8, Rational(1, 3)));
  EXPECT_DOUBLE_EQ(to_double(evaluate_power(10, Rational(1, 3)).value()), std::cbrt(10.0));
}

TEST(Powers, of_negative_numbers_that_are_too_long_to_be_exact_alternate) {
  const Rational tiny = parse_decimal("1e-50").value();
  for (const unsigned long exponent : {5001UL, 5002UL}) {
    Integer exact;
    mpz_pow_ui(exact.get_mpz_t(), Integer(-3).get_mpz_t(), exponent);
    const Rational value = evaluate_power(-3, exponent).value();
    EXPECT_NE(value, exact) << exponent;
    EXPECT_LT(abs(value / exact - 1), tiny) << exponent;
  }
}

}  // namespace
}  // namespace hamgen
