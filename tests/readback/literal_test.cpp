// Literals as the reader takes them, against those of the C library.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "generator/readback/machine_value.hpp"
#include "generator/readback/precision.hpp"

namespace hamgen {
namespace {

TEST(Literal, IsReadAsTheCLibraryDoes) {
  std::mt19937_64 source(1);
  std::uniform_int_distribution<int> digit(0, 9);
  std::uniform_int_distribution<int> exponent(-330, 300);
  for (int i = 0; i < 2000; ++i) {
    std::string text = "0.";
    for (int k = 0; k < 1 + i % 25; ++k) text += static_cast<char>('0' + digit(source));
    text += "e" + std::to_string(exponent(source));
    const double expected = std::strtod(text.c_str(), nullptr);
    EXPECT_EQ(read_literal(text)->value, from_double(expected)) << text;
    const float single = std::strtof(text.c_str(), nullptr);
    if (std::isfinite(single)) {
      EXPECT_EQ(read_literal(text + "f")->value, from_double(static_cast<double>(single))) << text;
    }
  }
}

TEST(Literal, IsHexadecimalOrAnIntegerOrNone) {
  EXPECT_EQ(read_literal("0x1p-52")->value, from_double(std::ldexp(1.0, -52)));
  EXPECT_EQ(read_literal("0x1.8p+1L")->value, Rational(3));
  EXPECT_EQ(read_literal("0x1.8p+1L")->bits, 64);
  EXPECT_TRUE(read_literal("12")->is_integer);
  EXPECT_FALSE(read_literal("12.")->is_integer);
  for (const char* text : {"12f", "1.0q", "1.0e", "1.0e999999999", "0x1p", "1.2.3", "1.0_x"})
    EXPECT_FALSE(read_literal(text)) << text;
}

TEST(Rounded, IsToEvenAndToTheSmallestNumbers) {
  const Precision& precision = precision_of("double");
  const Rational one(1);
  Rational ulp(1);
  mpq_div_2exp(ulp.get_mpq_t(), ulp.get_mpq_t(), 52);
  EXPECT_EQ(rounded(one + ulp / 2, precision), one);
  EXPECT_EQ(rounded(one + 3 * ulp / 2, precision), Rational(one + 2 * ulp));
  EXPECT_EQ(rounded(Rational(1, 3), precision), from_double(1.0 / 3.0));
  EXPECT_EQ(rounded(from_double(5e-324) / 3, precision), Rational(0));
  EXPECT_FALSE(is_rounded(Rational(one + ulp), one, precision));
  EXPECT_TRUE(is_rounded(one, one + ulp / 3, precision));
}

// Signs move through products and quotients, not through sums: of these a zero shows the order.
TEST(MachineValue, IsTheSameWhereRoundingIs) {
  const Precision& precision = precision_of("");
  const MachineValue a = machine_symbol("a");
  const MachineValue b = machine_symbol("b");
  const MachineValue c = machine_symbol("c");
  const auto same = [&](const MachineValue& x, const MachineValue& y) {
    return is_same(x, y, precision);
  };
  EXPECT_TRUE(same(-(a * b), -a * b));
  EXPECT_TRUE(same(a * b, b * a));
  EXPECT_TRUE(same(a / -b, -(a / b)));
  EXPECT_TRUE(same(a + b, b + a));
  EXPECT_FALSE(same(a / b, b / a));
  EXPECT_FALSE(same(-(a + b), -a + -b));
  EXPECT_FALSE(same((a + b) + c, a + (b + c)));
  EXPECT_FALSE(same((a * b) * c, a * (b * c)));
  EXPECT_FALSE(same((a + b) * c, a * c + b * c));
  EXPECT_FALSE(same(machine_call("magnitude", {-a + b}), machine_call("magnitude", {a + b})));
}

TEST(MachineValue, OfAnExpressionComputesIt) {
  const Expression x = Expression::symbol("x", 3);
  const Expression y = Expression::symbol("y", 1);
  const Expression e = Expression(Rational(-3, 7)) * x * y / (x + y * y) - square_root(x - y);
  EXPECT_TRUE(is_computed_as_meant(e));
}

}  // namespace
}  // namespace hamgen
