// Expressions in one canonical form.
#include "generator/algebra/expression.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace hamgen {
namespace {

const Expression x = Expression::symbol("x", 1);
const Expression y = Expression::symbol("y", 2);
const Expression z = Expression::symbol("z", 3);

Expression fraction(long over, long under) { return Expression(Rational(over, under)); }
Expression cosine(const Expression& e) { return Expression::apply("cos", {e}); }
Expression power(const Expression& e, long n) { return Expression::power(e, Expression(n)); }

TEST(Expression, DoesNotDependOnTheOrderOfItsOperands) {
  std::vector<Expression> terms{x, y * 2, x * y, cosine(x), Expression(3), power(x, 2), -z};
  const Expression sum = Expression::sum(terms);
  const Expression product = Expression::product(terms);
  // A few hundred of the permutations.
  std::ranges::sort(terms);
  for (int i = 0; i < 300 && std::ranges::next_permutation(terms).found; ++i) {
    EXPECT_EQ(Expression::sum(terms), sum);
    EXPECT_EQ(Expression::sum(terms).hash(), sum.hash());
    EXPECT_EQ(to_text(Expression::sum(terms)), to_text(sum));
    EXPECT_EQ(Expression::product(terms), product);
    EXPECT_EQ(to_text(Expression::product(terms)), to_text(product));
  }
}

TEST(Expression, IsOrderedByDeclaredRankAndNotByName) {
  const Expression late = Expression::symbol("a", 9);
  const Expression early = Expression::symbol("b", 1);
  EXPECT_EQ(to_text(late + early), "b + a");
  EXPECT_EQ(to_text(late * early), "b*a");
}

TEST(Expression, CollectsLikeTerms) {
  EXPECT_EQ(x + x, x * 2);
  EXPECT_TRUE((x - x).is_zero());
  EXPECT_TRUE((x * y - y * x).is_zero());
  EXPECT_EQ(to_text(x + y + x + 1 - y), "1 + 2*x");
  EXPECT_EQ(x * fraction(1, 3) + x * fraction(2, 3), x);
  EXPECT_EQ((x + y) + (x - y), x * 2);
}

TEST(Expression, CollectsPowersOfOneBase) {
  EXPECT_EQ(x * x, power(x, 2));
  EXPECT_TRUE((x / x).is_one());
  EXPECT_EQ(square_root(x) * square_root(x), x);
  EXPECT_EQ(x * square_root(x), Expression::power(x, fraction(3, 2)));
  EXPECT_EQ(power(x * y * 2, 3), power(x, 3) * power(y, 3) * 8);
  EXPECT_EQ(power(power(x, 2), 3), power(x, 6));
  EXPECT_TRUE(power(x, 0).is_one());
  EXPECT_EQ(power(x, 1), x);
}

TEST(Expression, KeepsWhatHoldsForSomeValuesOnly) {
  // sqrt(x^2) is |x|, and sqrt(x y) is not sqrt(x) sqrt(y) for negative x, y.
  EXPECT_NE(square_root(power(x, 2)), x);
  EXPECT_NE(square_root(x * y), square_root(x) * square_root(y));
  EXPECT_EQ(to_text(square_root(power(x, 2))), "sqrt(x^2)");
}

TEST(Expression, ADifferenceAndItsOppositeShareOneNode) {
  const auto [sign, inside] = (y - x).split_coefficient();
  EXPECT_EQ(sign, Rational(-1));
  EXPECT_EQ(inside, x - y);
  EXPECT_EQ(power(y - x, 2), power(x - y, 2));
  EXPECT_EQ(power(y - x, 3), -power(x - y, 3));
  EXPECT_EQ(fraction(1, 2) * x - fraction(1, 2) * y, fraction(1, 2) * (x - y));
  // A constant leads.
  EXPECT_EQ(to_text(x - 1), "-(1 - x)");
}

TEST(Expression, ANumericFactorStandsInFront) {
  const auto [coefficient, rest] = (x * fraction(-3, 7) * y * 7).split_coefficient();
  EXPECT_EQ(coefficient, Rational(-3));
  EXPECT_EQ(rest, x * y);
  EXPECT_TRUE((x * 0).is_zero());
  EXPECT_EQ(x * 1, x);
}

TEST(Expression, NumbersAreExact) {
  EXPECT_EQ(Expression(Rational(2, 4)), Expression(Rational(1, 2)));
  EXPECT_EQ(Expression(Rational(2, 4)).hash(), Expression(Rational(1, 2)).hash());
  EXPECT_EQ(power(Expression(Rational(2, 3)), -3), fraction(27, 8));
  const Expression tenth(*parse_decimal("0.1"));
  EXPECT_EQ(tenth + tenth + tenth, Expression(*parse_decimal("0.3")));
  // The square root of 2 stays one.
  EXPECT_EQ(square_root(Expression(2)) * square_root(Expression(2)), Expression(2));
}

TEST(Expression, ComparesInATotalOrder) {
  const std::vector<Expression> some{
      Expression(0), Expression(-1), fraction(1, 2), x,         y,     x * y, x + y,
      power(x, 2),   power(x, -1),   cosine(x),      cosine(y), x * 2, -x};
  for (const Expression& a : some) {
    for (const Expression& b : some) {
      EXPECT_EQ(a == b, (a <=> b) == 0) << to_text(a) << ", " << to_text(b);
      EXPECT_EQ(a<b, b> a) << to_text(a) << ", " << to_text(b);
      for (const Expression& c : some) {
        if (a < b && b < c) {
          EXPECT_LT(a, c);
        }
      }
    }
  }
}

TEST(Expression, TextHasTheFewestParentheses) {
  EXPECT_EQ(to_text(power(x, 2) / 2 - y * cosine(x)), "x^2/2 - y*cos(x)");
  EXPECT_EQ(to_text((x + y) * z), "z*(x + y)");
  EXPECT_EQ(to_text(x / (y * z)), "x/y/z");
  EXPECT_EQ(to_text(power(x, -2)), "1/x^2");
  EXPECT_EQ(to_text(power(-x, 2)), "x^2");
  EXPECT_EQ(to_text(Expression::power(x + y, Expression::symbol("n", 4))), "(x + y)^n");
  EXPECT_EQ(to_text(Expression::power(x, -y)), "x^(-y)");
}

TEST(Expression, SubstitutionReplacesAllAtOnce) {
  const Expression e = x * cosine(y) + power(y, 2);
  EXPECT_EQ(substitute(e, {{"x", y}, {"y", x}}), y * cosine(x) + power(x, 2));
  EXPECT_EQ(substitute(e, {{"x", Expression(0)}}), power(y, 2));
  EXPECT_TRUE(substitute(x - y, {{"x", y}}).is_zero());
}

TEST(Expression, KnowsItsSymbols) {
  EXPECT_EQ(symbols(x * cosine(y) + 2), (std::set<std::string>{"x", "y"}));
  EXPECT_TRUE(depends_on(x * cosine(y), "y"));
  EXPECT_FALSE(depends_on(x * cosine(y), "z"));
}

TEST(Expression, ASharedGraphIsSubstitutedInLinearTime) {
  // x -> cos(x) cos(x) + x, sixty times: 3^60 nodes as a tree.
  Expression e = x;
  for (int i = 0; i < 60; ++i) e = cosine(e) * cosine(e + y) + e * z;
  EXPECT_TRUE(depends_on(e, "x"));
  EXPECT_FALSE(depends_on(substitute(e, {{"x", y}}), "x"));
}

}  // namespace
}  // namespace hamgen
