#include "generator/mechanics/taylor.hpp"

#include <gtest/gtest.h>

#include "generator/algebra/derivative.hpp"
#include "tests/mechanics/tape.hpp"

namespace hamgen::mechanics_test {
namespace {

const Expression x = Expression::symbol("x", 1);
const Expression y = Expression::symbol("y", 2);
const Expression two(2);

Expression f(const char* name, const Expression& argument) {
  return Expression::apply(name, {argument});
}

// x + h, y + h y: with h inserted, the sum of the series to h^12 is the function at the moved
// point.
TEST(Taylor, SeriesOfEveryKindOfNodeSumToTheFunctionAtTheDisplacedPoint) {
  const std::vector<Expression> functions = {
      x * x * x * y,
      Expression::power(x, Expression(-3)) + y,
      Expression::power(x + y * y, Expression(Rational(-3, 2))),
      f("sin", x * y) * f("cos", x),
      f("exp", f("tanh", x)) / (Expression(1) + y * y),
      f("log", x + y),
      Expression::apply("atan2", {y, x}),
      Expression::power(x, y)};
  TaylorSeries series([](const Expression& symbol, int k) {
    if (k > 1) return Expression(0);
    return symbol == x ? Expression(1) : y;
  });
  const long double h = 0.01L;
  const Vector here = {1.25L, 0.75L};
  const Vector there = {1.25L + h, 0.75L * (1 + h)};
  for (const Expression& e : functions) {
    std::vector<Expression> terms;
    for (int k = 0; k <= 12; ++k) terms.push_back(series.coefficient(e, k));
    const Vector values = Tape(terms, {"x", "y"})(here);
    long double sum = 0;
    for (std::size_t k = values.size(); k-- > 0;) sum = sum * h + values[k];
    // Radii of convergence are above 1/2: what is cut off is below 50^-13 = 1e-22.
    EXPECT_NEAR(static_cast<double>(sum - Tape({e}, {"x", "y"})(there)[0]), 0, 2e-18) << to_text(e);
  }
}

TEST(Taylor, PositivePowersHoldAtZero) {
  TaylorSeries series([](const Expression&, int k) { return Expression(k == 1 ? 1 : 0); });
  const Expression second = series.coefficient(Expression::power(x, Expression(4)), 2);
  EXPECT_EQ(second, Expression(6) * x * x);
}

TEST(Derivative, SharedNodesAreDifferentiatedOnce) {
  // 60 squarings of a sum: its text would have 2^60 terms.
  Expression e = x + y;
  for (int i = 0; i < 60; ++i) e = e * e + Expression(1) / (e * e + Expression(1));
  const std::vector<Expression> variables = {x, y};
  const std::vector<Expression> slopes = gradient(e, variables);
  EXPECT_EQ(slopes[0], slopes[1]);
}

TEST(Derivative, AgreesWithDifferences) {
  const Expression e =
      Expression::apply("atan2", {x, y}) * Expression::power(y, x) + f("sin", x * x) / y;
  const std::vector<Expression> variables = {x, y};
  const Vector slopes = Tape(gradient(e, variables), {"x", "y"})({0.5L, 1.5L});
  const Tape value({e}, {"x", "y"});
  const long double h = 1e-5L;
  // Central differences: h^2/6 times third derivatives of order 10.
  EXPECT_NEAR(
      static_cast<double>((value({0.5L + h, 1.5L})[0] - value({0.5L - h, 1.5L})[0]) / (2 * h)),
      static_cast<double>(slopes[0]), 1e-9);
  EXPECT_NEAR(
      static_cast<double>((value({0.5L, 1.5L + h})[0] - value({0.5L, 1.5L - h})[0]) / (2 * h)),
      static_cast<double>(slopes[1]), 1e-9);
}

}  // namespace
}  // namespace hamgen::mechanics_test
