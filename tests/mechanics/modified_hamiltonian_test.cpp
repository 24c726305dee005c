// The Hamiltonian that a step follows.
#include "generator/mechanics/modified_hamiltonian.hpp"

#include <gtest/gtest.h>

#include "generator/algebra/derivative.hpp"
#include "generator/algebra/latex.hpp"
#include "generator/algebra/polynomial.hpp"
#include "generator/mechanics/curvature.hpp"
#include "generator/mechanics/generating_function.hpp"
#include "tests/mechanics/formal_step.hpp"

namespace hamgen::mechanics_test {
namespace {

bool same_terms(const Expression& a, const Expression& b) {
  PolynomialRing ring(10000);
  return ring.expand(a - b).empty();
}

const std::string modified_pendulum = "coordinate q\nmomentum p\nH = p^2/2 - cos(q)\n";

// The midpoint rule turns the oscillator by 2 atan(h/2) a step.
TEST(ModifiedHamiltonian, OfTheOscillatorIsThatOfTheArcTangent) {
  const Mechanics m = mechanics_of("coordinate q\nmomentum p\nH = (p^2 + q^2)/2\n");
  const auto terms = modified_hamiltonian(m, {}, 0, 7);
  const std::vector<Rational> series = {1, Rational(-1, 12), Rational(1, 80), Rational(-1, 448)};
  for (std::size_t k = 0; k < series.size(); ++k) {
    EXPECT_TRUE(same_terms(terms[2 * k], Expression(series[k]) * m.energy))
        << to_text(terms[2 * k]);
  }
}

// Ht = H + h^2 [ (1/2) grad H^T C1 J grad H - (1/24) H''(J grad H, J grad H) ] for C = h C1.
TEST(ModifiedHamiltonian, HasTheKnownSecondTermForAGaugeProportionalToTheStep) {
  const Mechanics m = mechanics_of("coordinate q\nmomentum p\nH = (q^2 + 1)*(p^2 + 1)/2\n");
  const Expression beta(Rational(1, 5));
  const Expression gamma(Rational(-1, 7));
  const Expression& by_q = m.gradient[0];
  const Expression& by_p = m.gradient[1];
  // C1 = [[0, -gamma], [-beta, 0]], J grad H = (H_p, -H_q).
  const Expression gauge = (gamma * by_q * by_q - beta * by_p * by_p) / Expression(2);
  const Expression bend = m.second_derivative(0, 0) * by_p * by_p -
                          Expression(2) * m.second_derivative(0, 1) * by_p * by_q +
                          m.second_derivative(1, 1) * by_q * by_q;
  const auto terms = modified_hamiltonian(m, scheme_of(m, {"1/2", "h/5", "-h/7"}).member().c, 0, 3);
  EXPECT_TRUE(same_terms(terms[2], gauge - bend / Expression(24))) << to_text(terms[2]);
}

// That of the midpoint is H - (h^2/24) H''(J grad H, J grad H) + O(h^4).
TEST(ModifiedHamiltonian, OfTheMidpointBeginsWithTheCurvatureAlongTheFlow) {
  for (const char* text : {"coordinate q\nmomentum p\nH = (q^2 + 1)*(p^2 + 1)/2\n",
                           "coordinate q\nmomentum p\nH = p^2/2 - cos(q) + p*q^3\n",
                           "coordinate x, y\nmomentum px, py\nH = (px^2 + py^2)/2 + x*py*(1 + y^2) "
                           "- y*px + x^2*y\n"}) {
    const Mechanics m = mechanics_of(text);
    const NamedExpression curvature = energy_curvature(m).front();
    EXPECT_EQ(curvature.name, "energy_curvature");
    EXPECT_TRUE(same_terms(modified_hamiltonian(m, {}, 0, 3)[2],
                           curvature.value / Expression(Rational(-24))))
        << text << to_text(curvature.value);
  }
}

// With K of order R, Ht departs from H at h^R only.
TEST(ModifiedHamiltonian, BeginsWithThePowerOfTheOrder) {
  const Mechanics m = mechanics_of(modified_pendulum);
  for (const Gauge& gauge : {Gauge{}, Gauge{"3/10", "1/5", "-1/10"}, Gauge{"0", "h", "0"}}) {
    const SparseMatrix c = scheme_of(m, gauge).member().c;
    const auto terms = modified_hamiltonian(m, c, 4, 5);
    for (std::size_t j = 1; j < 4; ++j) EXPECT_TRUE(terms[j].is_zero()) << j << to_text(terms[j]);
    EXPECT_FALSE(terms[4].is_zero());
  }
}

// Along the numerical orbit of the pendulum at h = 0.1: the variation of Ht falls with every term.
TEST(ModifiedHamiltonian, IsConstantAlongTheOrbitToTheNextOrder) {
  const Mechanics m = shipped("pendulum");
  const auto terms = modified_hamiltonian(m, {}, 0, 7);
  const FormalStep step(m, scheme_of(m, {}).member(), m.gradient);
  const Tape tape(terms, {"q", "p", "eps"});
  const long double h = 0.1L;
  Vector variation(4);
  Vector first;
  Vector z = {3.1L, 0};
  for (int i = 0; i < 200; ++i, z = step.after(10, z, h)) {
    const Vector values = tape({z[0], z[1], 0.03L});
    Vector sums(4);
    long double power = 1;
    for (std::size_t k = 0; k < 4; ++k, power *= h * h) {
      sums[k] = (k > 0 ? sums[k - 1] : 0) + power * values[2 * k];
    }
    if (first.empty()) first = sums;
    for (std::size_t k = 0; k < 4; ++k) {
      variation[k] = std::max(variation[k], std::abs(sums[k] - first[k]));
    }
  }
  EXPECT_NEAR(static_cast<double>(variation[0]), 1.5e-6, 1e-7);
  // Each factor is h^2 times a few times eps; 1e-19 is the rounding of a thousand steps.
  EXPECT_LT(variation[1], 1e-3L * variation[0]);
  EXPECT_LT(variation[2], 1e-3L * variation[1]);
  EXPECT_LT(variation[3], std::max(1e-2L * variation[2], 1e-18L));
}

// Negative control: half the second term leaves half the variation.
TEST(ModifiedHamiltonian, WithAWrongTermIsNotConstant) {
  const Mechanics m = shipped("pendulum");
  const auto terms = modified_hamiltonian(m, {}, 0, 3);
  const FormalStep step(m, scheme_of(m, {}).member(), m.gradient);
  const Tape tape({terms[0] + Expression(Rational(1, 200)) * terms[2]}, {"q", "p", "eps"});
  const Vector far = step.after(607, {3.1L, 0}, 0.1L);  // half a period: the largest change
  EXPECT_GT(std::abs(tape({3.1L, 0, 0.03L})[0] - tape({far[0], far[1], 0.03L})[0]), 0);
  long double most = 0;
  for (Vector z = {3.1L, 0}; most == 0 || z[0] > 0; z = step.after(10, z, 0.1L)) {
    most = std::max(most, std::abs(tape({z[0], z[1], 0.03L})[0] - tape({3.1L, 0, 0.03L})[0]));
  }
  EXPECT_GT(most, 1e-7L);
}

TEST(Latex, SetsFractionsPowersGreekLettersAndSubscripts) {
  const Expression q = Expression::symbol("q1", 1);
  const Expression w = Expression::symbol("omega", 0);
  const Expression p = Expression::symbol("p[2]", 2);
  EXPECT_EQ(to_latex(p * p / Expression(2) - w * Expression::apply("cos", {q})),
            "\\frac{p_{2}^{2}}{2} - \\omega \\cos\\left(q_{1}\\right)");
  EXPECT_EQ(to_latex((p + q) / Expression(3)), "\\frac{q_{1} + p_{2}}{3}");
}

}  // namespace
}  // namespace hamgen::mechanics_test
