// There and back across the border with GiNaC.
#include "generator/algebra/from_ginac.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hamgen {
namespace {

class Border : public ::testing::Test {
 protected:
  SymbolTable table;
  GiNaC::ex gx = table.symbol("x", 1);
  GiNaC::ex gy = table.symbol("y", 2);
  Expression x = Expression::symbol("x", 1);
  Expression y = Expression::symbol("y", 2);

  Expression round_trip(const Expression& e) { return from_ginac(to_ginac(e, table), table); }
};

TEST_F(Border, AnExpressionComesBackAsItWas) {
  const Expression half(Rational(1, 2));
  for (const Expression& e :
       {x, Expression(0), Expression(Rational(-7, 3)), x + y, x - y, x * y * 3,
        Expression::power(x, Expression(-2)), square_root(x * x + y * y), x / y,
        half * x - half * y, Expression::apply("cos", {x - y}), Expression::apply("exp", {-x}),
        Expression::apply("tanh", {x * 2}), Expression::power(x, y),
        Expression::apply("atan2", {y, x}), Expression::symbol("pi") * x}) {
    EXPECT_EQ(round_trip(e), e) << to_text(e) << " became " << to_text(round_trip(e));
  }
}

TEST_F(Border, HugeAndTinyNumbersCrossExactly) {
  for (const char* text : {"123456789012345678901", "1e-320", "1e300", "0.1"}) {
    const Rational value = *parse_decimal(text);
    EXPECT_EQ(to_rational(to_ginac(value)), value) << text;
    EXPECT_EQ(round_trip(Expression(value) * x), Expression(value) * x) << text;
  }
}

TEST_F(Border, DerivativesAreThoseOfTheTextbook) {
  const GiNaC::symbol& s = table.find("x");
  auto derivative = [&](const Expression& e) {
    return from_ginac(to_ginac(e, table).diff(s), table);
  };
  EXPECT_EQ(derivative(Expression::power(x, Expression(3))), Expression(3) * x * x);
  EXPECT_EQ(derivative(Expression::apply("cos", {x * y})),
            -(y * Expression::apply("sin", {x * y})));
  EXPECT_EQ(derivative(square_root(x)), Expression(Rational(1, 2)) / square_root(x));
  EXPECT_TRUE(derivative(y).is_zero());
}

TEST_F(Border, TheOrderInWhichGinacHoldsTermsDoesNotShow) {
  // Many symbols: GiNaC orders them by hashes of addresses.
  std::vector<GiNaC::ex> terms;
  for (int i = 0; i < 40; ++i) {
    std::string name = "q";
    name += std::to_string(i);
    terms.push_back(table.symbol(name, 10 + i) * (i + 1) * GiNaC::sin(gx + i));
  }
  GiNaC::ex forward = 0;
  GiNaC::ex backward = 0;
  for (const GiNaC::ex& term : terms) forward += term;
  for (auto it = terms.rbegin(); it != terms.rend(); ++it) backward += *it;
  EXPECT_EQ(to_text(from_ginac(forward, table)), to_text(from_ginac(backward, table)));
  EXPECT_EQ(to_text(from_ginac(forward, table)).substr(0, 29), "q0*sin(x) + 2*q1*sin(1 + x) +");
}

TEST_F(Border, WhatWouldExpandToMillionsOfTermsIsNotExpanded) {
  std::vector<Expression> nine;
  for (int i = 1; i <= 9; ++i) nine.push_back(Expression::symbol("x" + std::to_string(i)));
  const Expression sum = Expression::sum(nine);
  const auto power = [](const Expression& base, int exponent) {
    return Expression::power(base, Expression(exponent));
  };
  EXPECT_TRUE(vanishes((x + y) * (x - y) - x * x + y * y));
  // What stands in a root is no factor of the terms outside, and not expanded if it is long itself.
  EXPECT_TRUE(vanishes((power(sum, 2) * x - x * power(sum, 2)) / square_root(power(sum, 2) + 1)));
  EXPECT_TRUE(vanishes(((x + 1) * (x - 1) - x * x + 1) * square_root(power(sum, 4) + x)));
  EXPECT_FALSE(vanishes(power(sum, 30) - power(sum, 29) * sum + x));
  EXPECT_FALSE(vanishes(x / square_root(power(sum, 30) + y)));
  EXPECT_FALSE(vanishes(x / power(power(sum, 30) + y, 2)));
}

TEST_F(Border, ComplexNumbersAreRefused) {
  EXPECT_THROW((void)from_ginac(GiNaC::I * gx, table), std::domain_error);
  EXPECT_THROW((void)from_ginac(GiNaC::sqrt(GiNaC::ex(-1)) + gx, table), std::domain_error);
}

}  // namespace
}  // namespace hamgen
