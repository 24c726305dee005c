// Enclosures hold what they enclose.
#include "generator/verify/interval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "generator/algebra/evaluate.hpp"

namespace hamgen {
namespace {

// Of one expression, which shares nothing with others.
std::optional<Interval> enclosure(const Expression& e,
                                  const std::map<std::string, Interval>& symbols) {
  const auto values = Enclosures({e}).at(symbols);
  return values ? std::optional(values->at(0)) : std::nullopt;
}

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

// What they share is looked at once, and is what each has by itself; one that is not defined
// everywhere leaves none.
TEST(Enclosures, OfSeveralAreThoseOfEach) {
  const Expression x = Expression::symbol("x");
  const Expression y = Expression::symbol("y");
  const Expression part = Expression::apply("exp", {x * x - y});
  const std::vector<Expression> expressions = {part, part * part + Expression(Rational(1, 3)),
                                               Expression::apply("sin", {part}) - x, y,
                                               Expression(2)};
  const Enclosures together(expressions);
  for (const double low : {-3.0, 0.0, 0.5}) {
    const std::map<std::string, Interval> box = {{"x", {low, low + 0.25}}, {"y", {-1.0, 2.0}}};
    const auto values = together.at(box);
    ASSERT_TRUE(values);
    ASSERT_EQ(values->size(), expressions.size());
    for (std::size_t i = 0; i < expressions.size(); ++i) {
      const auto alone = enclosure(expressions[i], box);
      ASSERT_TRUE(alone) << i;
      EXPECT_EQ((*values)[i].low, alone->low) << i;
      EXPECT_EQ((*values)[i].high, alone->high) << i;
    }
  }
  const Enclosures undefined({x, Expression::apply("log", {x})});
  EXPECT_TRUE(undefined.at({{"x", {1.0, 2.0}}}));
  EXPECT_FALSE(undefined.at({{"x", {-1.0, 2.0}}}));
  EXPECT_FALSE(together.at({{"x", {0.0, 1.0}}}));
}

TEST(Enclosures, OfASumEndAtTheNextNumbers) {
  using Limits = std::numeric_limits<double>;
  constexpr double kInfinity = Limits::infinity();
  for (const double size : {0.0, Limits::denorm_min(), Limits::min(), 1.0, 1.0 + Limits::epsilon(),
                            2.0, 1e300, Limits::max(), kInfinity}) {
    for (const double x : {size, -size}) {
      const Interval sum = Interval{x, x} + Interval{};
      EXPECT_EQ(sum.low, std::nextafter(x, -kInfinity)) << x;
      EXPECT_EQ(sum.high, std::nextafter(x, kInfinity)) << x;
    }
  }
}

}  // namespace
}  // namespace hamgen
