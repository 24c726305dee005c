#include "generator/program/linear_terms.hpp"

#include <gtest/gtest.h>

#include "tests/planner/emitted_text.hpp"

namespace hamgen {
namespace {

const Expression q = Expression::symbol("q");
const Expression r = Expression::symbol("r");
const Expression k = Expression::symbol("k");
const Expression a = Expression::symbol("a");
const LinearTerms kTerms({"q", "r"});

const auto kHigh = [](const std::string& c) { return Expression::symbol("high(" + c + ")"); };
const auto kLow = [](const std::string& c) { return Expression::symbol("low(" + c + ")"); };

Expression split(const Expression& e) {
  return kTerms.split(
      e, {.in_two_parts =
              [](const Expression& c) {
                return Parts{kHigh(to_text(c)), kLow(to_text(c))};
              },
          .at_stage = [](const Expression& sum) { return sum; },
          .of_small_parts =
              [](const Expression& sum) { return Expression::symbol("[" + to_text(sum) + "]"); }});
}

TEST(LinearTerms, AreConstantsTimesSumsOfTheState) {
  EXPECT_TRUE(kTerms.are_in(q));
  EXPECT_TRUE(kTerms.are_in(k * (q - r)));
  EXPECT_TRUE(kTerms.are_in(q * q * a + k * q));
  EXPECT_TRUE(kTerms.are_in(-(q * r + Expression(3) * (q - r))));
  EXPECT_FALSE(kTerms.are_in(q * r));
  EXPECT_FALSE(kTerms.are_in(k * a));
  EXPECT_FALSE(kTerms.are_in(a * Expression::apply("sin", {q})));
  EXPECT_FALSE(kTerms.are_in(k * (q + r * r) * q));
}

TEST(LinearTerms, HaveTheirConstantInTwoPartsUnlessItIsAPowerOfTwo) {
  const auto in_parts = [](const char* c, const Expression& x) {
    return kHigh(c) * x + kLow(c) * x;
  };
  EXPECT_EQ(split(k * (q - r)), in_parts("k", q - r));
  EXPECT_EQ(split(Expression(2) * k * q), Expression(2) * in_parts("k", q));
  EXPECT_EQ(split(Expression(3) * k * q), in_parts("3*k", q));
  EXPECT_EQ(split(Expression(Rational(13, 10)) * q), in_parts("13/10", q));
  EXPECT_EQ(split(Expression(Rational(1, 3)) * q), in_parts("1/3", q));
  EXPECT_EQ(split(Expression(Rational(1, 4)) * q), q / Expression(4));
  EXPECT_EQ(split(q - r), q - r);
  EXPECT_EQ(split(a * q * q + k * r), a * q * q + in_parts("k", r));
  EXPECT_EQ(split(a * Expression::apply("sin", {q})), a * Expression::apply("sin", {q}));
}

// The products of the small parts are added to each other before they meet the others.
TEST(LinearTerms, HaveASumOfTheirSmallParts) {
  const Expression low = Expression(2) * kLow("k") * q - kLow("a") * (q - r);
  EXPECT_EQ(split(Expression(2) * k * q - a * (q - r) + q * q),
            Expression(2) * kHigh("k") * q - kHigh("a") * (q - r) + q * q +
                Expression::symbol("[" + to_text(low) + "]"));
}

// Their sum may cancel, and what is left has few digits.
TEST(LinearTerms, MayBeAllOfAForceWhereAParameterIsZero) {
  EXPECT_TRUE(kTerms.may_be_all_of(k * q - r));
  EXPECT_TRUE(kTerms.may_be_all_of(k * q + a * q * q));
  EXPECT_TRUE(kTerms.may_be_all_of(k * q - a));
  EXPECT_TRUE(kTerms.may_be_all_of(k * q - Expression(1)));
  EXPECT_FALSE(kTerms.may_be_all_of(k * q + Expression(2) * q * r));
  EXPECT_FALSE(kTerms.may_be_all_of(Expression::apply("sin", {q})));
}

// Only forces that are linear in part, and whose equations are solved, have constants in two parts.
TEST(LinearTerms, AreSplitWhereAForceHasThemAlone) {
  const auto solve_of = [](const std::string& hamiltonian, const std::string& scheme) {
    const std::string text = planner_test::one + "parameter c = 1.3\nH = p^2/2 + " + hamiltonian;
    return planner_test::outcome(text + "\n", {.scheme = scheme}).header;
  };
  const auto contains = planner_test::contains;
  for (const char* scheme : {"implicit-midpoint", "gauss-4"}) {
    EXPECT_TRUE(contains(solve_of("c*q^2/2 + q^4/4", scheme), "= 0.9999 * par.c")) << scheme;
    // A number stays one that the compiler does not know to be all but the other.
    const std::string of_number = solve_of("1.3*q^2/2 + q^4/4", scheme);
    EXPECT_TRUE(contains(of_number, " = 1.29987;")) << scheme;
    EXPECT_TRUE(contains(of_number, " = 1.3 - ")) << scheme;
    EXPECT_FALSE(contains(solve_of("c*cos(q)", scheme), "0.9999")) << scheme;
  }
  EXPECT_FALSE(contains(solve_of("c*q^2/2 + q^4/4", "stormer-verlet"), "0.9999"));
}

// A constant force leaves a sum of linear terms as few digits.
TEST(LinearTerms, OfAForceOfNothingElseHaveTheStepInTwoParts) {
  const auto kick = [](const std::string& hamiltonian) {
    const std::string text =
        planner_test::one + "parameter c = 1.3\nparameter f = 0\nH = p^2/2 + " + hamiltonian;
    return planner_test::contains(planner_test::outcome(text + "\n").header, "dz.p = -h * H_q");
  };
  EXPECT_FALSE(kick("c*q^2/2 + f*q^3/3"));
  EXPECT_FALSE(kick("c*q^2/2 - f*q + c*q^3*f"));
  EXPECT_TRUE(kick("c*q^2/2 + q^4/4"));
}

}  // namespace
}  // namespace hamgen
