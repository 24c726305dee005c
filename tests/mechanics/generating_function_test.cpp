// K in place of H: any member at any order.
#include "generator/mechanics/generating_function.hpp"

#include <gtest/gtest.h>

#include "generator/algebra/derivative.hpp"
#include "generator/algebra/polynomial.hpp"
#include "generator/base/diagnostic.hpp"
#include "tests/mechanics/formal_step.hpp"

namespace hamgen::mechanics_test {
namespace {

const std::string pendulum = "coordinate q\nmomentum p\nH = p^2/2 - cos(q)\n";

// Equal after expansion?
bool same(const Expression& a, const Expression& b) {
  PolynomialRing ring(10000);
  return ring.expand(a - b).empty();
}

std::vector<Expression> series(const Mechanics& m, const SparseMatrix& c, int count,
                               SeriesForm form) {
  const auto gauge = gauge_series(c, count);
  return generating_series(m.energy, coordinate_chart(m, gauge), gauge, count, form);
}

TEST(GeneratingSeries, OfThePendulumAtTheMidpointHasTheKnownSecondTerm) {
  const Mechanics m = shipped("pendulum");
  const Expression p = m.variable(1);
  const Expression eps = Expression::symbol("eps", kRankOfParameter);
  const Expression sine = Expression::apply("sin", {m.variable(0)});
  const Expression cosine = Expression::apply("cos", {m.variable(0)});
  // K = H + h^2/24 (eps cos q p^2 + eps^2 sin^2 q) + O(h^4).
  const Expression known = (eps * cosine * p * p + eps * eps * sine * sine) / Expression(24);
  for (const SeriesForm form : {SeriesForm::nested, SeriesForm::expanded}) {
    const auto terms = series(m, {}, 3, form);
    EXPECT_EQ(terms[0], m.energy);
    EXPECT_TRUE(terms[1].is_zero());
    EXPECT_TRUE(same(terms[2], known)) << to_text(terms[2]);
  }
}

TEST(GeneratingSeries, IsTheSameInBothForms) {
  for (const std::string& text :
       {pendulum, std::string("coordinate q\nmomentum p\nH = (q^2 + 1)*(p^2 + 1)/2\n"),
        std::string("coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x^2*y - y^3/3\n")}) {
    const Mechanics m = mechanics_of(text);
    for (const Gauge& gauge :
         {Gauge{}, Gauge{"3/10", "1/5", "-1/10"}, Gauge{"1/2", "h/5", "2*h"}}) {
      const SparseMatrix c = scheme_of(m, gauge).member().c;
      const auto nested = series(m, c, 5, SeriesForm::nested);
      const auto expanded = series(m, c, 5, SeriesForm::expanded);
      for (std::size_t k = 0; k < nested.size(); ++k)
        EXPECT_TRUE(same(nested[k], expanded[k])) << k;
    }
  }
}

// Of tan(h)/h - 1 = h^2/3 + 2 h^4/15 + ... nothing may be lost where zero meets its reciprocal.
TEST(GaugeSeries, GoesThroughPolesThatCancel) {
  const Expression h = Expression::symbol("h", kRankOfStep);
  const Expression tangent = Expression::apply("tan", {h}) / h;
  const auto gauge = gauge_series({{{0, 0}, tangent - Expression(1)}}, 5);
  EXPECT_TRUE(gauge[0].empty());
  EXPECT_EQ(gauge[2].at({0, 0}), Expression(Rational(1, 3)));
  EXPECT_EQ(gauge[4].at({0, 0}), Expression(Rational(2, 15)));
  EXPECT_THROW(static_cast<void>(gauge_series({{{0, 0}, Expression(1) / h}}, 3)), UsageError);
}

// For H = (p^2 + q^2)/2 and C = 0 the flow is the midpoint step of (2/h) tan(h/2) H.
TEST(GeneratingSeries, OfTheOscillatorIsThatOfTheTangent) {
  const Mechanics m = mechanics_of("coordinate q\nmomentum p\nH = (p^2 + q^2)/2\n");
  const auto terms = series(m, {}, 9, SeriesForm::expanded);
  const std::vector<Rational> tangent = {1, Rational(1, 12), Rational(1, 120), Rational(17, 20160),
                                         Rational(31, 362880)};
  for (std::size_t k = 0; k < tangent.size(); ++k) {
    EXPECT_TRUE(same(terms[2 * k], Expression(tangent[k]) * m.energy)) << k;
  }
}

// Coefficients of 1, h, h^2, ...
using InStep = std::vector<Rational>;
constexpr std::size_t most_terms = 11;

InStep times(const InStep& a, const InStep& b) {
  InStep result(most_terms);
  for (std::size_t i = 0; i < most_terms; ++i)
    for (std::size_t j = 0; i + j < most_terms; ++j) result[i + j] += a[i] * b[j];
  return result;
}

InStep over(const InStep& a, const InStep& b) {
  InStep result(most_terms);
  for (std::size_t i = 0; i < most_terms; ++i) {
    Rational rest = a[i];
    for (std::size_t j = 0; j < i; ++j) rest -= result[j] * b[i - j];
    result[i] = rest / b[0];
  }
  return result;
}

InStep sum_of(const InStep& a, const InStep& b, const Rational& factor) {
  InStep result = a;
  for (std::size_t i = 0; i < most_terms; ++i) result[i] += factor * b[i];
  return result;
}

std::string text_of_series(const InStep& a) {
  std::string text = "0";
  for (std::size_t i = 0; i < most_terms; ++i)
    text += " + (" + a[i].get_str() + ")*h^" + std::to_string(i);
  return text;
}

// For H = (p^2 + q^2)/2 the flow is the rotation exp(h J), so that S = z A z/2 with
// A = ((I/2) cot(h/2) + C J)^-1, C J = [[gamma, alpha - 1/2], [alpha - 1/2, -beta]].
TEST(GeneratingSeries, OfTheOscillatorIsExactForAGaugeWithEveryPowerOfTheStep) {
  InStep sine(most_terms);
  InStep cosine(most_terms);
  Rational power = 1;  // (1/2)^k/k! with the signs of cos + sin
  for (std::size_t k = 0; k < most_terms; ++k) {
    (k % 2 == 0 ? cosine : sine)[k] = power;
    power *= Rational(k % 2 == 0 ? 1 : -1, 2 * (static_cast<long>(k) + 1));
  }
  const InStep tangent = over(sum_of(sine, sine, 1), cosine);  // 2 tan(h/2)
  InStep offset(most_terms);                                   // alpha - 1/2
  InStep beta(most_terms);
  InStep gamma(most_terms);
  for (long k = 0; k < static_cast<long>(most_terms); ++k) {
    const auto i = static_cast<std::size_t>(k);
    offset[i] = Rational(1, 3 + k);
    beta[i] = Rational(k % 3 - 1, 2 + k);
    gamma[i] = Rational(k + 2, 7);
  }
  InStep one(most_terms);
  one[0] = 1;
  const InStep q_part = sum_of(one, times(beta, tangent), -1);
  const InStep p_part = sum_of(one, times(gamma, tangent), 1);
  const InStep mixed = times(offset, tangent);
  const InStep scale = over(tangent, sum_of(times(q_part, p_part), times(mixed, mixed), -1));

  const Mechanics m = mechanics_of("coordinate q\nmomentum p\nH = (p^2 + q^2)/2\n");
  const Gauge gauge{"1/2 + " + text_of_series(offset), text_of_series(beta), text_of_series(gamma)};
  const auto terms = series(m, scheme_of(m, gauge).member().c, static_cast<int>(most_terms) - 1,
                            SeriesForm::expanded);
  const Expression q = m.variable(0);
  const Expression p = m.variable(1);
  const InStep of_qq = times(scale, q_part);
  const InStep of_pp = times(scale, p_part);
  const InStep of_qp = times(scale, mixed);
  for (std::size_t k = 1; k < most_terms; ++k) {
    const Expression known = (Expression(of_qq[k]) * q * q + Expression(of_pp[k]) * p * p) / 2 -
                             Expression(of_qp[k]) * q * p;
    EXPECT_TRUE(same(terms[k - 1], known)) << k << ": " << to_text(terms[k - 1] - known);
  }
}

TEST(GeneratingFunction, RefusesAGaugeWithoutASeriesInTheStep) {
  const Mechanics m = mechanics_of(pendulum);
  const SparseMatrix c = scheme_of(m, {"1/2", "1/h", "0"}).member().c;
  EXPECT_THROW((void)generating_function(m, c, 4), UsageError);
}

TEST(GeneratingFunction, TooLongANamesWhatIsPossible) {
  try {
    (void)generating_function(shipped("double_pendulum"), {}, 8);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("--order 6 takes"), std::string::npos) << error.what();
  }
}

struct Problem {
  const char* name;
  std::string text;
  Vector start;
  long double t;
  int steps;
};

// A2, A8, B1 and B2 of the literature's test problems, at large steps.
const Problem a2{"pendulum", pendulum, {2, 0}, 4, 8};
const Problem a8{
    "product", "coordinate q\nmomentum p\nH = (q^2 + 1)*(p^2 + 1)/2\n", {0, -3}, 0.5L, 8};
const Problem b1{
    "henon_heiles",
    "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2 + x^2 + y^2)/2 + x^2*y - y^3/3\n",
    {0.1L, 0.2L, 0.3L, -0.1L},
    4,
    8};
const Problem b2{"kepler",
                 "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 - 1/sqrt(x^2 + y^2)\n",
                 {0.8L, 0, 0, 1.2247448713915890491L},
                 1,
                 10};

void expect_order(const Problem& problem, const Gauge& gauge, int order, double tolerance) {
  const Mechanics m = mechanics_of(problem.text);
  const Scheme scheme = scheme_of(m, gauge);
  const auto k = generating_function(m, scheme.member().c, order);
  const FormalStep step(m, scheme.member(), k.gradient);
  // Its error is 1e-3^5: far below those of the steps.
  const Vector exact = flow(m, problem.start, problem.t, 4000);
  const auto orders = observed_orders(step, problem.start, problem.t, problem.steps, exact);
  EXPECT_NEAR(orders.back(), order, tolerance) << problem.name << ", order " << order;
}

class SymmetricOrder : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(All, SymmetricOrder, ::testing::Values(4, 6, 8, 10));

TEST_P(SymmetricOrder, OfTheMidpointIsObserved) {
  for (const Problem& problem : {a2, a8, b1, b2}) expect_order(problem, {}, GetParam(), 0.2);
}

TEST_P(SymmetricOrder, WithAGaugeProportionalToTheStepIsObserved) {
  expect_order(a2, {"1/2", "h/5", "-h/7"}, GetParam(), 0.2);
}

TEST(Order, OfKeplerInQuadraticFormsHoldsForOtherGaugesToo) {
  const auto k = generating_function(mechanics_of(b2.text), {}, 8);
  EXPECT_NE(k.form.find("3 quadratic forms"), std::string::npos) << k.form;
  EXPECT_LT(k.operations, 250);  // in coordinates it takes 1462
  expect_order(b2, {"1/2", "h/5", "-h/7"}, 6, 0.2);
  Problem finer = b2;
  finer.steps = 40;
  expect_order(finer, {"3/10", "1/5", "-1/10"}, 3, 0.2);
}

TEST(Order, OfTheDoublePendulumIsObserved) {
  const Mechanics m = shipped("double_pendulum");
  const Vector start = {1.5L, 1.5L, 0, 0};
  const Vector exact = flow(m, start, 1, 2000);
  for (const int order : {4, 6}) {
    const auto k = generating_function(m, {}, order);
    const FormalStep step(m, scheme_of(m, {}).member(), k.gradient);
    EXPECT_NEAR(observed_orders(step, start, 1, 8, exact).back(), order, 0.2);
  }
}

class AnyOrder : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(All, AnyOrder, ::testing::Values(2, 3, 4, 5, 6, 8, 9));

TEST_P(AnyOrder, OfAMemberThatIsNotSymmetricIsObserved) {
  Problem finer = a2;
  finer.steps = 32;
  expect_order(finer, {"3/10", "1/5", "-1/10"}, GetParam(), 0.2);
  expect_order(finer, {"3/10", "1/5 + h/3", "-h/10"}, GetParam(), 0.2);
  if (GetParam() > 6) return;  // its K is long, and the test is not about its length
  finer = a8;
  finer.steps = 32;
  expect_order(finer, {"0", "0", "0"}, GetParam(), 0.3);
}

// Negative control: one coefficient off by a thousandth.
TEST(Order, IsLostWithAWrongCoefficient) {
  const Mechanics m = mechanics_of(pendulum);
  const Expression h = Expression::symbol("h", kRankOfStep);
  auto terms = series(m, {}, 5, SeriesForm::expanded);
  terms[4] = terms[4] * Expression(Rational(1001, 1000));
  Expression k;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    k += Expression::power(h, Expression(static_cast<long>(i))) * terms[i];
  }
  const std::vector<Expression> z = {m.variable(0), m.variable(1)};
  const FormalStep step(m, scheme_of(m, {}).member(), gradient(k, z));
  const auto orders = observed_orders(step, a2.start, 4, 64, flow(m, a2.start, 4, 4000));
  EXPECT_LT(orders.back(), 5);
}

}  // namespace
}  // namespace hamgen::mechanics_test
