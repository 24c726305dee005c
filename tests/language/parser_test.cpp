#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "generator/language/read_model.hpp"
#include "generator/language/scene.hpp"

namespace hamgen {
namespace {

// The expression as it is understood, printed with the fewest parentheses.
std::string reread(const std::string& text) {
  return to_text(read_expression("text", text, {"a", "b", "c", "m[1]", "m[2]"}));
}

Rational value_of(const std::string& text) {
  return evaluate_constant(read_expression("text", text, {}), make_source("text", text), {});
}

TEST(Parser, powers_group_to_the_right) {
  EXPECT_EQ(value_of("2^3^2"), 512);
  EXPECT_EQ(value_of("(2^3)^2"), 64);
  EXPECT_EQ(reread("(a^b)^c"), "(a^b)^c");
  EXPECT_EQ(reread("a^(b^c)"), "a^b^c");
}

TEST(Parser, a_sign_is_weaker_than_a_power_and_allowed_in_an_exponent) {
  EXPECT_EQ(value_of("-3^2"), -9);
  EXPECT_EQ(value_of("(-3)^2"), 9);
  EXPECT_EQ(value_of("2^-3"), Rational(1, 8));
  EXPECT_EQ(value_of("2^-3^2"), Rational(1, 512));
  EXPECT_EQ(value_of("2*-3"), -6);
  EXPECT_EQ(value_of("--3"), 3);
  EXPECT_EQ(value_of("+3"), 3);
}

TEST(Parser, sums_and_products_group_to_the_left) {
  EXPECT_EQ(value_of("10 - 3 - 2"), 5);
  EXPECT_EQ(value_of("12/2/3"), 2);
  EXPECT_EQ(value_of("12/2*3"), 18);
}

TEST(Parser, printing_keeps_the_parentheses_that_matter) {
  for (const std::string text :
       {"a - (b - c)", "a - b - c", "a/(b*c)", "a/b*c", "a*(b + c)", "-(a + b)", "-a*b", "(-a)^2",
        "-a^2", "a^-2", "a + (-b)", "a*(-b)", "(a/b)^c", "a^(b + c)", "m[2]*sin(a)", "atan2(a, b)",
        "sum(i = 1..2, j = i + 1..2, m[i]*m[j])", "1e-30*a", "0.1*a"}) {
    EXPECT_EQ(reread(text), text);
  }
}

TEST(Parser, numbers_are_exact) {
  EXPECT_EQ(value_of("0.1"), Rational(1, 10));
  EXPECT_EQ(value_of(".5e1"), 5);
  EXPECT_EQ(value_of("1.e-2"), Rational(1, 100));
  EXPECT_EQ(value_of("1/3 + 1/6"), Rational(1, 2));
  EXPECT_EQ(value_of("123456789012345678901"), Rational("123456789012345678901"));
  EXPECT_EQ(reread("123456789.123456789123456789"), "123456789123456789123456789e-18");
}

TEST(Parser, sums_of_constants_add_up) {
  EXPECT_EQ(value_of("sum(i = 1..100, i)"), 5050);
  EXPECT_EQ(value_of("sum(i = 1..3, j = i+1..3, 10*i + j)"), 12 + 13 + 23);
  EXPECT_EQ(value_of("sum(i = 3..1, i)"), 0);
}

}  // namespace
}  // namespace hamgen
