// Enclosures hold what they enclose.
#include "generator/verify/interval.hpp"

#include <gtest/gtest.h>

#include <random>

#include "generator/algebra/evaluate.hpp"

namespace hamgen {
namespace {

TEST(Enclosures, HoldTheValuesOfEveryPointInside) {
  const Expression x = Expression::symbol("x");
  const auto f = [&](const char* name) { return Expression::apply(name, {x}); };
  const std::vector<Expression> expressions = {f("sin"),
                                               f("cos"),
                                               f("tan"),
                                               f("exp"),
                                               f("sinh"),
                                               f("cosh"),
                                               f("tanh"),
                                               f("atan"),
                                               f("asinh"),
                                               f("abs"),
                                               f("sqrt"),
                                               f("log"),
                                               x * x * x - x,
                                               Expression(1) / (x * x),
                                               Expression::power(x, Expression(Rational(3, 2))),
                                               f("sin") * f("cos") + Expression::symbol("pi") * x};
  std::mt19937_64 source(2);
  std::uniform_real_distribution<double> any(-8.0, 8.0);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int held = 0;
  for (int i = 0; i < 400; ++i) {
    const double low = any(source);
    const Interval inside{low, low + std::pow(part(source), 4.0)};
    const Rational point = from_double(inside.low + part(source) * (inside.high - inside.low));
    if (!inside.holds(to_double(point))) continue;
    for (const Expression& e : expressions) {
      const auto found = enclosure(e, {{"x", inside}});
      const auto value = evaluate(e, {{"x", point}});
      if (!found || !value) continue;
      EXPECT_TRUE(found->holds(to_double(*value))) << to_text(e) << " at " << to_double(point);
      ++held;
    }
  }
  EXPECT_GT(held, 4000);
  EXPECT_FALSE(enclosure(f("log"), {{"x", {-1.0, 1.0}}}));
  EXPECT_FALSE(enclosure(Expression::symbol("y"), {{"x", {-1.0, 1.0}}}));
  EXPECT_FALSE(std::isfinite(enclosure(Expression(1) / x, {{"x", {-1.0, 1.0}}})->high));
}

}  // namespace
}  // namespace hamgen
