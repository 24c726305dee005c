#include "generator/algebra/functions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace hamgen {
namespace {

using Real = double (*)(double);

const std::map<std::string, Real>& library() {
  static const std::map<std::string, Real> functions = {
      {"abs", std::fabs},    {"acos", std::acos}, {"acosh", std::acosh}, {"asin", std::asin},
      {"asinh", std::asinh}, {"atan", std::atan}, {"atanh", std::atanh}, {"cos", std::cos},
      {"cosh", std::cosh},   {"exp", std::exp},   {"log", std::log},     {"sin", std::sin},
      {"sinh", std::sinh},   {"sqrt", std::sqrt}, {"tan", std::tan},     {"tanh", std::tanh}};
  return functions;
}

TEST(Functions, are_in_alphabetical_order) {
  EXPECT_TRUE(std::ranges::is_sorted(all_functions(), {}, &Function::name));
}

// The two agree to the last bit or two of the library, and in where they are defined.
TEST(Functions, have_the_values_of_the_library_where_it_has_any) {
  for (const Function& function : all_functions()) {
    if (function.arity != 1) continue;
    const Real real = library().at(std::string(function.name));
    for (const double x : {-40.0, -3.5, -1.0, -0.75, 0.0, 1e-9, 0.3, 1.0, 2.0, 100.0, 1e15}) {
      const Rational argument = from_double(x);
      const auto value = evaluate_function(function.name, std::span(&argument, 1));
      const double expected = real(x);
      const bool grows = std::isinf(expected) && function.domain == "all x";
      EXPECT_TRUE(grows || value.has_value() == std::isfinite(expected)) << function.name << x;
      if (value && std::isfinite(expected)) {
        EXPECT_NEAR(to_double(*value), expected, 4e-16 * std::abs(expected)) << function.name << x;
      }
    }
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

}  // namespace
}  // namespace hamgen
