// The linear part of a step: matrices against exact flows, bounds against closed forms and powers.
#include "generator/verify/linear_stability.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/schemes/locally_exact.hpp"
#include "generator/schemes/read_gauge.hpp"
#include "generator/verify/linear_step.hpp"

namespace hamgen {
namespace {

using Eigen::MatrixXd;

Expression exact(double value) { return Expression(from_double(value)); }
Expression h() { return Expression::symbol("h", kRankOfStep); }

Scheme member_of(int n, Expression alpha, Expression beta, Expression gamma) {
  return family_member(n, {{std::move(alpha)}}, {{std::move(beta)}}, {{std::move(gamma)}});
}

Scheme named(const std::string& name, int n) {
  Scheme scheme = *find_scheme(name);
  if (scheme.is_member()) {
    const auto [alpha, beta, gamma] = uniform_parameters(scheme.member()).value();
    return member_of(n, alpha, beta, gamma);
  }
  if (auto* composition = std::get_if<Composition>(&scheme.method))
    composition->base.degrees_of_freedom = n;
  return scheme;
}

QuadraticPart part_of(const MatrixXd& s) {
  return {static_cast<int>(s.rows() / 2), {s.data(), s.data() + s.size()}};
}

QuadraticPart oscillator(double w) { return {1, {w * w, 0, 0, 1}}; }

// Springs of different strength between different masses: V and T do not commute.
MatrixXd chain() {
  MatrixXd s = MatrixXd::Zero(6, 6);
  s.topLeftCorner(3, 3) << 3, -2, 0, -2, 7, -5, 0, -5, 6;
  s.bottomRightCorner(3, 3).diagonal() << 1, 0.5, 0.2;
  return s;
}

// exp(A) by squaring a Taylor series whose argument is below 2^-10: its rest is below rounding.
MatrixXd exponential(MatrixXd a) {
  constexpr int halvings = 14;
  a /= std::pow(2.0, halvings);
  MatrixXd sum = MatrixXd::Identity(a.rows(), a.cols());
  MatrixXd term = sum;
  for (int k = 1; k < 12; ++k) {
    term = term * a / k;
    sum += term;
  }
  for (int i = 0; i < halvings; ++i) sum = MatrixXd(sum * sum);
  return sum;
}

// The error of a step of order p is h^(p+1) (c + O(h)): halving h divides it by 2^(p+1), up to 20 %
// at these h.  A wrong matrix would have another order.
TEST(LinearStep, OfEverySchemeHasItsOrderAgainstTheExactFlow) {
  std::vector<Scheme> schemes;
  for (const Scheme& scheme : all_schemes()) schemes.push_back(named(scheme.name, 3));
  const Scheme general = member_of(3, Expression(Rational(1, 3)), Expression(Rational(1, 5)),
                                   Expression(Rational(-1, 7)));
  schemes.push_back(general);
  for (const int order : {2, 3, 4, 5}) schemes.push_back(raise_order(general, order));
  for (const int order : {4, 6}) {
    schemes.push_back(raise_order(named("implicit-midpoint", 3), order));
    schemes.push_back(raise_order(
        member_of(3, Expression(Rational(1, 2)), h() / Expression(7), h() / Expression(9)), order));
  }
  const MatrixXd a = linear_flow(chain());
  int seen = 0;
  for (const Scheme& scheme : schemes) {
    const LinearStep step(scheme, {});
    const auto error = [&](double x) {
      return (step.matrix(x, chain()) - exponential(x * a)).norm();
    };
    // The error is above rounding, and the frequencies, up to 2.3, times h are small.
    double step_size = 0.1;
    while (error(step_size) < 1e-9 && step_size < 1.0) step_size *= 1.5;
    if (scheme.order > 8) continue;  // where the error is above rounding, h is no longer small
    const double order = std::log2(error(step_size) / error(step_size / 2)) - 1.0;
    EXPECT_NEAR(order, scheme.order, 0.35) << scheme.name << " at h = " << step_size;
    ++seen;
  }
  EXPECT_GT(seen, 40);
}

TEST(LinearStability, OfVerletAndEulerEndsWhereTheStepTimesTheFrequencyIsTwo) {
  for (const char* name :
       {"stormer-verlet", "position-verlet", "symplectic-euler-a", "symplectic-euler-b"}) {
    for (const double w : {0.01, 1.0, 300.0}) {
      const auto at = [&](double step) {
        return linear_stability(oscillator(w), named(name, 1), {}, step);
      };
      const LinearStability inside = at(1.999 / w);
      EXPECT_EQ(inside.verdict, Verdict::proved) << name;
      EXPECT_NEAR(inside.largest_h.value() * w, 2.0, 1e-13) << name;
      EXPECT_EQ(at(2.001 / w).verdict, Verdict::refuted) << name;
      EXPECT_FALSE(at(2.001 / w).largest_h) << name;
      EXPECT_FALSE(at(1.0 / w).iteration_radius) << name << " has nothing to iterate";
    }
  }
}

// At h w = 2 itself: M = -[[1, x], [0, 1]].
TEST(LinearStability, OfVerletAtItsBoundIsRefutedByAJordanBlock) {
  const LinearStability found =
      linear_stability(oscillator(1.0), named("stormer-verlet", 1), {}, 2);
  EXPECT_EQ(found.verdict, Verdict::refuted);
  EXPECT_NE(found.detail.find("Jordan block"), std::string::npos) << found.detail;
}

// Stable again beyond the first bound, as a polynomial of the trace is.
TEST(LinearStability, OfACompositionListsItsGaps) {
  const LinearStability found =
      linear_stability(oscillator(1.0), named("forest-ruth-4", 1), {}, Rational(1));
  EXPECT_EQ(found.verdict, Verdict::tested);
  const LinearStep step(named("forest-ruth-4", 1), {});
  MatrixXd s = MatrixXd::Identity(2, 2);
  // At every h on a fine grid the trace says the same as the intervals, but next to their ends.
  for (double h = 0.01; h < 6.0; h += 0.01) {
    const double trace = std::abs(step.matrix(h, s).trace());
    if (std::abs(trace - 2.0) < 1e-3) continue;
    const bool inside = std::ranges::any_of(found.bounded_steps, [h](const auto& interval) {
      return interval.first < h && h < interval.second;
    });
    EXPECT_EQ(inside, trace < 2.0) << h;
  }
}

TEST(LinearStability, OfTheMidpointRuleHasNoBoundAndItsAnglesAreKnown) {
  for (const double step : {1e-3, 0.5, 2.0, 1e4}) {
    const double w = 3.0;
    const LinearStability found =
        linear_stability(oscillator(w), named("implicit-midpoint", 1), {}, step);
    EXPECT_EQ(found.verdict, Verdict::proved);
    EXPECT_TRUE(found.bounded_for_every_h);
    ASSERT_EQ(found.angles.size(), 1u);
    EXPECT_NEAR(found.angles[0], 2.0 * std::atan(step * w / 2.0), 1e-12);
    EXPECT_NEAR(found.iteration_radius.value(), step * w / 2.0, 1e-12 * step * w);
    for (const int m : {3, 4, 5, 6})
      EXPECT_NEAR(found.resonant_h.at(m), 2.0 * std::tan(std::numbers::pi / m) / w, 1e-9) << m;
  }
}

// The matrix of the step against the closed form, at parameters on both sides.
TEST(LinearStability, OfAMemberIsTheClosedCondition) {
  std::mt19937_64 source(3);
  std::uniform_real_distribution<double> any(-2.0, 2.0);
  int bounded = 0;
  int unbounded = 0;
  for (int i = 0; i < 200; ++i) {
    const double w = std::exp(any(source));
    const double step = std::exp(any(source)) / w;
    const double alpha = 0.5 + any(source);
    const double beta = any(source) / step;
    const double gamma = any(source) / (step * w * w);
    const double margin = linear_margin(step, w * w, alpha, beta, gamma);
    if (std::abs(margin) < 1e-6) continue;
    const LinearStability found = linear_stability(
        oscillator(w), member_of(1, exact(alpha), exact(beta), exact(gamma)), {}, step);
    EXPECT_EQ(found.verdict, margin > 0.0 ? Verdict::proved : Verdict::refuted)
        << alpha << ' ' << beta << ' ' << gamma << ' ' << step << ' ' << w;
    ++(margin > 0.0 ? bounded : unbounded);
  }
  EXPECT_GT(bounded, 30);
  EXPECT_GT(unbounded, 30);
}

// alpha = 1/2: bounded iff X = (1 + h beta)(1 - h w^2 gamma) > 0.
TEST(LinearStability, OfTunedParametersEndsWhereXChangesItsSign) {
  const double w = 2.0;
  const auto largest = [&](const Expression& beta, const Expression& gamma) {
    return linear_stability(oscillator(w), member_of(1, Expression(Rational(1, 2)), beta, gamma),
                            {}, 0.1)
        .largest_h;
  };
  EXPECT_NEAR(largest(exact(-0.5), Expression(0)).value(), 2.0, 1e-8);
  EXPECT_NEAR(largest(Expression(0), exact(0.125)).value(), 2.0, 1e-8);
  // gamma = h/12: 1 - h^2 w^2/12.
  EXPECT_NEAR(largest(Expression(0), h() / Expression(12)).value(), std::sqrt(12.0) / w, 1e-8);
  EXPECT_FALSE(largest(exact(0.5), exact(-0.125)));
  EXPECT_TRUE(linear_stability(oscillator(w),
                               member_of(1, Expression(Rational(1, 2)), exact(0.5), exact(-0.125)),
                               {}, Rational(1, 10))
                  .bounded_for_every_h);
}

// Normal modes, or all degrees of freedom at once: the powers of the matrix themselves decide.
TEST(LinearStability, OfACoupledChainIsWhatThePowersOfItsMatrixDo) {
  int bounded = 0;
  int unbounded = 0;
  for (const char* kind : {"stormer-verlet", "alpha", "beta", "forest-ruth-4", "rk4"}) {
    Scheme scheme = named("stormer-verlet", 3);
    if (std::string(kind) == "alpha") {
      scheme = member_of(3, Expression(Rational(1, 5)), Expression(0), Expression(0));
    } else if (std::string(kind) == "beta") {
      scheme = member_of(3, Expression(Rational(1, 2)), exact(-0.7), exact(0.05));
    } else if (std::string(kind) != "stormer-verlet") {
      scheme = named(kind, 3);
    }
    for (double step = 0.3; step < 4.0; step *= 1.23) {
      const LinearStability found = linear_stability(part_of(chain()), scheme, {}, step);
      MatrixXd power = LinearStep(scheme, {}).matrix(step, chain());
      const double start = power.norm();
      for (int k = 0; k < 14; ++k) power = MatrixXd(power * power);  // 16384 steps
      // Bounded powers stay below the condition of the eigenvectors, some tens here; unbounded ones
      // grow by the margin a step, more than 1e-3 at these h.
      const bool stays = power.allFinite() && power.norm() < 1e3 * start;
      EXPECT_TRUE(stays ? holds(found.verdict) : found.verdict == Verdict::refuted)
          << kind << " at h = " << step << ": " << found.detail;
      ++(stays ? bounded : unbounded);
    }
  }
  EXPECT_GT(bounded, 15);
  EXPECT_GT(unbounded, 15);
}

TEST(LinearStability, OfALocallyExactGaugeIsTheExactFlowAtItsReference) {
  const Mechanics mechanics = derive(read_model(make_source(
      "m.ham",
      "system m\ncoordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + 2*x^2 + x*y + 9*y^2 + "
      "x^4\n")));
  const Values origin = {{"x", 0}, {"y", 0}, {"px", 0}, {"py", 0}};
  const Scheme scheme = locally_exact_member(mechanics, origin);
  MatrixXd s = MatrixXd::Zero(4, 4);
  s.topLeftCorner(2, 2) << 4, 1, 1, 18;
  s.bottomRightCorner(2, 2).setIdentity();
  const LinearStep step(scheme, {});
  for (const double x : {0.1, 1.0, 2.0}) {
    EXPECT_LT((step.matrix(x, s) - exponential(x * linear_flow(s))).norm(), 1e-11) << x;
    EXPECT_EQ(linear_stability(part_of(s), scheme, {}, x).verdict, Verdict::tested);
  }
}

TEST(LinearStability, OfRungeAndKuttaDampsUpToTheRootOfEight) {
  const LinearStability found = linear_stability(oscillator(1.0), named("rk4", 1), {}, 1.0);
  EXPECT_EQ(found.verdict, Verdict::proved);
  EXPECT_GT(found.margin.value(), 0.0);
  EXPECT_NEAR(found.largest_h.value(), std::sqrt(8.0), 1e-13);
  EXPECT_EQ(linear_stability(oscillator(1.0), named("rk4", 1), {}, 2.9).verdict, Verdict::refuted);
}

Expression decimal(const std::string& text) { return Expression(*parse_decimal(text)); }

GaugeBlock block(std::vector<Expression> entries) { return {std::move(entries)}; }

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

TEST(LinearStability, OfExplicitEulerHasNoBound) {
  for (const double step : {1e-6, 0.1, 10.0}) {
    const LinearStability found =
        linear_stability(oscillator(2.0), named("explicit-euler", 1), {}, step);
    EXPECT_EQ(found.verdict, Verdict::refuted);
    EXPECT_FALSE(found.largest_h);
    EXPECT_TRUE(found.bounded_steps.empty());
    EXPECT_FALSE(found.bounded_for_every_h);
  }
  const LinearStability member = linear_stability(
      oscillator(1.0), member_of(1, decimal("0.5"), Expression(-300), Expression(0)), {},
      *parse_decimal("0.005"));
  EXPECT_EQ(member.verdict, Verdict::refuted);
  EXPECT_FALSE(member.largest_h);
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

TEST(LinearPoints, AreTheInitialStateAndAnEquilibriumAtTheOrigin) {
  const Mechanics pendulum = derive(read_model(make_source(
      "m.ham",
      "system m\ncoordinate q\nmomentum p\nparameter eps = 0.03\nH = p^2/2 - eps*cos(q)\n")));
  const std::map<std::string, Rational> upright = {
      {"q", from_double(3.1)}, {"p", 0}, {"eps", Rational(3, 100)}};
  const auto points = linear_points(pendulum, named("stormer-verlet", 1), upright, 0.1);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].place, "initial state");
  EXPECT_TRUE(points[0].stability.frequencies.empty());
  EXPECT_NEAR(points[0].stability.growth_rate, std::sqrt(-0.03 * std::cos(3.1)), 1e-12);
  EXPECT_EQ(points[0].stability.verdict, Verdict::not_decided);
  EXPECT_EQ(points[1].place, "origin");
  EXPECT_NEAR(points[1].stability.frequencies.at(0), std::sqrt(0.03), 1e-14);
  EXPECT_NEAR(points[1].stability.largest_h.value(), 2.0 / std::sqrt(0.03), 1e-7);

  // No equilibrium at the origin: the force there is not 0.
  const Mechanics slope = derive(read_model(
      make_source("m.ham", "system m\ncoordinate q\nmomentum p\nH = p^2/2 + q + q^4\n")));
  EXPECT_EQ(linear_points(slope, named("implicit-midpoint", 1), {{"q", 1}, {"p", 0}}, 0.1).size(),
            1u);
}

}  // namespace
}  // namespace hamgen
