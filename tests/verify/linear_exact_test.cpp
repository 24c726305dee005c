// The linear part of a step, decided in rationals and by intervals of h: where no grid of steps and
// no rounded eigenvalue would see it.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "generator/verify/linear_stability.hpp"
#include "generator/verify/linear_step.hpp"
#include "tests/verify/linear_problems.hpp"

namespace hamgen {
namespace {

using Eigen::MatrixXd;
using linear_problems::block;
using linear_problems::decimal;
using linear_problems::h;
using linear_problems::member_of;
using linear_problems::named;
using linear_problems::oscillator;

// w1 (q1^2 + p1^2)/2 - w2 (q2^2 + p2^2)/2 - a q1 q2 - b q1 p2.
QuadraticPart two_oscillators(const char* w1, const char* w2, const char* a, const char* b) {
  const Rational p = *parse_decimal(w1);
  const Rational m = -*parse_decimal(w2);
  const Rational qq = -*parse_decimal(a);
  const Rational qp = -*parse_decimal(b);
  return {2, {p, qq, 0, qp, qq, m, 0, 0, 0, 0, p, 0, qp, 0, 0, m}};
}

// Exact rational discriminants put two eigenvalues together between 1.0067 and 1.0360, 3 % of h.
TEST(LinearStability, OfOscillatorsThatCollideHasAGapThatNoGridSees) {
  const QuadraticPart part{
      2,
      {*parse_decimal("1.207"), *parse_decimal("-0.021"), 0, *parse_decimal("0.015"),
       *parse_decimal("-0.021"), *parse_decimal("-0.694"), 0, 0, 0, 0, *parse_decimal("1.207"), 0,
       *parse_decimal("0.015"), 0, 0, *parse_decimal("-0.694")}};
  const Scheme scheme = family_member(2, block({Expression(1), Expression(0)}),
                                      block({Expression(0), decimal("0.751") * h()}),
                                      block({Expression(0), decimal("-0.379") * h()}));
  const auto at = [&](const char* step) {
    return linear_stability(part, scheme, {}, *parse_decimal(step));
  };
  const LinearStability inside = at("0.5");
  EXPECT_EQ(inside.verdict, Verdict::proved);
  ASSERT_EQ(inside.bounded_steps.size(), 2U);
  EXPECT_NEAR(inside.largest_h.value(), 1.0067, 1e-4);
  EXPECT_NEAR(inside.bounded_steps[1].first, 1.0360, 1e-4);
  EXPECT_NEAR(inside.bounded_steps[1].second, 1.1850118, 1e-7);
  const LinearStability in_gap = at("1.02");
  EXPECT_EQ(in_gap.verdict, Verdict::refuted);
  EXPECT_FALSE(in_gap.largest_h);
  EXPECT_TRUE(in_gap.bounded_steps.empty());
  EXPECT_EQ(at("1.1").verdict, Verdict::proved);
  EXPECT_EQ(at("1.2").verdict, Verdict::refuted);
}

// The eigenvalues have left the circle by 5e-6, which rounding does not show.
TEST(LinearStability, OfAGrowthBelowRoundingIsRefuted) {
  const Scheme scheme = family_member(2, block({decimal("0.5"), Expression(0)}),
                                      block({decimal("-0.846") * h(), decimal("-0.983") * h()}),
                                      block({decimal("-0.526") * h(), decimal("0.082") * h()}));
  const QuadraticPart part = two_oscillators("1.749", "1.794", "0.037", "0.024");
  for (const char* step : {"0.0205", "0.021"})
    EXPECT_EQ(linear_stability(part, scheme, {}, *parse_decimal(step)).verdict, Verdict::refuted);
}

// A complex quadruple of eigenvalues of the flow, as close to the axis as one likes.
TEST(LinearStability, OfAFlowThatGrowsSlowlyIsNotProved) {
  for (const char* coupling : {"4e-7", "1e-12", "1e-40"}) {
    const Rational c = *parse_decimal(coupling);
    const QuadraticPart part{2, {1, c, 0, 0, c, -1, 0, 0, 0, 0, 1, -c, 0, 0, -c, -1}};
    for (const char* scheme : {"implicit-midpoint", "gauss-4"}) {
      const LinearStability found = linear_stability(part, named(scheme, 2), {}, 1);
      EXPECT_EQ(found.growing, 2) << coupling;
      EXPECT_TRUE(found.frequencies.empty());
      EXPECT_FALSE(holds(found.verdict));
    }
  }
}

// beta = -sin(h) is no rational function: intervals of h, against the closed condition
// (1 + h beta)(1 - h w^2 gamma) > 0 and, for two coupled oscillators, the powers of M.
TEST(LinearStability, OfOtherFunctionsOfTheStepIsEnclosed) {
  const Expression beta = -Expression::apply("sin", {h()});
  const LinearStability of_one = linear_stability(
      oscillator(1.0), member_of(1, Expression(Rational(1, 2)), beta, Expression(0)), {},
      Rational(1, 10));
  EXPECT_EQ(of_one.verdict, Verdict::tested);
  // h sin(h) = 1, up to an interval or two of 1e-6 of h that stay open there.
  EXPECT_NEAR(of_one.largest_h.value(), 1.1141571408719, 1e-5);
  for (const auto& [from, to] : of_one.bounded_steps) {
    const double middle = 0.5 * (from + to);
    EXPECT_LT(middle * std::sin(middle), 1.0) << middle;
  }
  const QuadraticPart part{
      2, {2, Rational(1, 2), 0, 0, Rational(1, 2), 3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  const Scheme two = family_member(2, block({decimal("0.5")}), block({Expression(0), beta}),
                                   block({Expression(0)}));
  const LinearStability found = linear_stability(part, two, {}, Rational(1, 10));
  EXPECT_EQ(found.verdict, Verdict::tested);
  ASSERT_TRUE(found.largest_h);
  MatrixXd s(4, 4);
  for (Eigen::Index k = 0; k < 16; ++k)
    s(k / 4, k % 4) = to_double(part.hessian[static_cast<std::size_t>(k)]);
  for (const double factor : {0.5, 0.9, 0.99, 1.01, 1.1}) {
    MatrixXd power = LinearStep(two, {}).matrix(factor * *found.largest_h, s);
    for (int k = 0; k < 14; ++k) power = MatrixXd(power * power);
    EXPECT_EQ(power.allFinite() && power.norm() < 1e4, factor < 1.0) << factor;
  }
}

// Random quadratic H, definite or not, with random parameters of the family for each degree of
// freedom, constant or odd in h: what is called bounded stays so, what is not grows.
TEST(LinearStability, OfRandomMembersIsWhatThePowersDo) {
  std::mt19937_64 source(11);
  const auto part_of_one = [&] { return Rational(static_cast<long>(source() % 401) - 200, 200); };
  int bounded = 0;
  int unbounded = 0;
  for (int i = 0; i < 60; ++i) {
    QuadraticPart part{2, std::vector<Rational>(16)};
    MatrixXd s(4, 4);
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t column = row; column < 4; ++column) {
        Rational entry = part_of_one() / 4;
        if (row == column) entry += (i % 2 == 0 || row % 2 == 0) ? 1 : -1;
        entry.canonicalize();
        part.hessian[4 * row + column] = part.hessian[4 * column + row] = entry;
      }
    }
    for (Eigen::Index k = 0; k < 16; ++k)
      s(k / 4, k % 4) = to_double(part.hessian[static_cast<std::size_t>(k)]);
    const auto entries = [&](const Expression& factor) {
      return block({Expression(part_of_one()) * factor, Expression(part_of_one()) * factor});
    };
    const Expression factor = i % 3 == 0 ? Expression(1) : h();
    GaugeBlock alpha = entries(i % 3 == 0 ? Expression(1) : Expression(0));
    for (Expression& e : alpha.entries) e += Expression(Rational(1, 2));
    const Scheme scheme = family_member(2, alpha, entries(factor), entries(factor));
    const Rational step = Rational(static_cast<long>(source() % 300) + 1, 200);
    const LinearStability found = linear_stability(part, scheme, {}, step);
    if (found.frequencies.size() < 2 || found.verdict == Verdict::not_decided) continue;
    MatrixXd power = LinearStep(scheme, {}).matrix(found.h, s);
    for (int k = 0; k < 20; ++k) power = MatrixXd(power * power);  // a million steps
    const bool stays = power.allFinite() && power.norm() < 1e6;
    EXPECT_EQ(found.verdict, stays ? Verdict::proved : Verdict::refuted)
        << i << ' ' << found.detail;
    // And the intervals say the same as the verdict.
    const bool inside = std::ranges::any_of(found.bounded_steps, [&](const auto& interval) {
      return interval.first < found.h && found.h < interval.second;
    });
    EXPECT_EQ(inside, stays) << i;
    ++(stays ? bounded : unbounded);
  }
  EXPECT_GT(bounded, 10);
  EXPECT_GT(unbounded, 5);
}

// Equal frequencies are common, and harmless for every h: they do not collide.
TEST(LinearStability, OfEqualFrequenciesIsThatOfOne) {
  // An isotropic oscillator turned by a rotation that couples its coordinates, x y and u v.
  const QuadraticPart part{2, {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  const Scheme beta =
      member_of(2, Expression(Rational(1, 2)), h() * decimal("0.25"), Expression(0));
  const LinearStability of_two = linear_stability(part, beta, {}, Rational(1, 10));
  const LinearStability of_one = linear_stability(
      {1, {2, 0, 0, 1}},
      member_of(1, Expression(Rational(1, 2)), h() * decimal("0.25"), Expression(0)), {},
      Rational(1, 10));
  EXPECT_EQ(of_two.verdict, Verdict::proved);
  EXPECT_EQ(of_two.bounded_steps, of_one.bounded_steps);
  // Coupled by C alone, so that no part is alone.
  const Scheme coupled = family_member(
      2, block({decimal("0.5")}),
      {{h() / Expression(4), h() / Expression(8), h() / Expression(8), h() / Expression(4)}, true},
      block({Expression(0)}));
  EXPECT_EQ(linear_stability(part, coupled, {}, Rational(1, 10)).verdict, Verdict::proved);
}

}  // namespace
}  // namespace hamgen
