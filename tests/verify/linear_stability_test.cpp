// The linear part of a step: matrices against exact flows, bounds against closed forms and powers.
#include "generator/verify/linear_stability.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "generator/language/read_model.hpp"
#include "generator/mechanics/derive.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/schemes/locally_exact.hpp"
#include "generator/schemes/read_gauge.hpp"
#include "generator/verify/linear_step.hpp"
#include "tests/verify/linear_problems.hpp"

namespace hamgen {
namespace {

using Eigen::MatrixXd;
using linear_problems::chain;
using linear_problems::decimal;
using linear_problems::exact;
using linear_problems::h;
using linear_problems::member_of;
using linear_problems::named;
using linear_problems::oscillator;
using linear_problems::part_of;

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
