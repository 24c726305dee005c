// Values, gradients and Hessians in balls, from the model as it is written.
#include <gtest/gtest.h>

#include <cmath>

#include "app/studies/ball_model.hpp"
#include "generator/algebra/functions.hpp"
#include "generator/language/read_model.hpp"

namespace hamgen::certify_test {
namespace {

using app::Ball;
using app::BallJet;
using app::BallModel;

constexpr long kJetBits = 128;

struct Written {
  explicit Written(const std::string& text)
      : model(read_model(make_source("test.ham", "system test\n" + text), {})),
        balls(model, {{"a", Ball(0.75, kJetBits)}, {"m[1]", Ball(2)}, {"m[2]", Ball(3)}},
              kJetBits) {}

  [[nodiscard]] BallJet at(const std::vector<Ball>& z) const { return balls.hamiltonian(z, true); }

  Model model;
  BallModel balls;
};

std::vector<Ball> point(const std::vector<double>& z) {
  std::vector<Ball> result;
  for (const double value : z) result.emplace_back(value, kJetBits);
  return result;
}

double slope(const BallJet& jet, int i) {
  const auto it = jet.gradient.find(i);
  return it == jet.gradient.end() ? 0.0 : it->second.nearest();
}
double curvature(const BallJet& jet, int i, int j) {
  const auto it = jet.hessian.find(std::minmax(i, j));
  return it == jet.hessian.end() ? 0.0 : it->second.nearest();
}

// Central differences over d = 2^-20 err by d^2/6 f''' of the functions below, at most 1e-10 here;
// those of the values, 128 bits, lose nothing.  A wrong derivative errs by parts of 1.
void expect_derivatives(const std::string& text, const std::vector<double>& z) {
  const Written written(text);
  const BallJet here = written.at(point(z));
  const double d = std::ldexp(1.0, -20);
  EXPECT_TRUE(here.value.is_finite()) << text;
  for (std::size_t i = 0; i < z.size(); ++i) {
    std::vector<double> up = z;
    std::vector<double> down = z;
    up[i] += d;
    down[i] -= d;
    const BallJet above = written.at(point(up));
    const BallJet below = written.at(point(down));
    const int k = static_cast<int>(i);
    const double by_values = (above.value - below.value).nearest() / (2 * d);
    EXPECT_NEAR(slope(here, k), by_values, 1e-9 * (1 + std::fabs(by_values))) << text << i;
    for (int j = 0; j < static_cast<int>(z.size()); ++j) {
      const double by_slopes = (slope(above, j) - slope(below, j)) / (2 * d);
      EXPECT_NEAR(curvature(here, k, j), by_slopes, 1e-8 * (1 + std::fabs(by_slopes)))
          << text << i << j;
    }
  }
}

TEST(BallJet, KnowsTheDerivativesOfEveryFunctionOfTheLanguage) {
  for (const Function& function : all_functions()) {
    const std::string name(function.name);
    EXPECT_TRUE(app::has_ball_derivatives(name)) << name;
    const std::string arguments = function.arity == 2 ? "(q*p, p + q)" : "(q*p - q)";
    // q p - q = 0.27, or 1.35 where acosh begins.
    const std::vector<double> z = name == "acosh" ? std::vector{0.9, 2.5} : std::vector{0.9, 1.3};
    expect_derivatives("coordinate q\nmomentum p\nH = p^2/2 + " + name + arguments + "\n", z);
  }
  EXPECT_FALSE(app::has_ball_derivatives("zeta"));
}

TEST(BallJet, KnowsPowersAndQuotients) {
  for (const std::string term : {"q^3*p", "q^(-2)*p^2", "(q*p)^(1/2)", "(q + p)^(1/3)", "q^p",
                                 "q^a", "(p - a*q)/(q^2 + p)", "q^1", "q^0*p", "(q*p)^2"})
    expect_derivatives("coordinate q\nmomentum p\nparameter a = 3/4\nH = " + term + " + p*q\n",
                       {0.7, 1.3});
}

TEST(BallJet, KnowsSumsArraysDefinitionsAndTime) {
  expect_derivatives(
      "size N = 3\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 2\nmomentum p[1..N]\n"
      "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, exp(q[i+1] - q[i]))\n",
      {0.1, 0.4, -0.3, 0.2, 0.5, 0.7});
  expect_derivatives(
      "coordinate q[1..2] periodic\nmomentum p[1..2]\nparameter m[1..2] = [2, 3]\n"
      "let r = sqrt(q[1]^2 + q[2]^2)\nH = sum(i = 1..2, p[i]^2/(2*m[i]) + q[i+1]*r) + sin(pi*r)\n",
      {0.1, 0.4, -0.3, 0.2});
  expect_derivatives("time t\ncoordinate q\nmomentum p\nH = p^2/2 + q*cos(t)\n",
                     {0.3, 0.2, 0.5, 0.7});
}

// p_t stands for the energy that the drive puts in.
TEST(BallJet, OfATimeDependentHamiltonianHasItsPartner) {
  const Written written("time t\ncoordinate q\nmomentum p\nH = p^2/2 + q*cos(t)\n");
  const BallJet jet = written.at(point({0.3, 0.2, 0.5, 0.7}));
  double ones = 0;
  for (int i = 0; i < 4; ++i) ones += slope(jet, i) == 1.0 ? 1 : 0;
  EXPECT_EQ(ones, 1);
}

TEST(BallJet, IsNotFiniteOutsideTheDomain) {
  for (const auto& [term, q] : std::vector<std::pair<std::string, double>>{{"log(q)", -1.0},
                                                                           {"sqrt(q)", -1.0},
                                                                           {"1/q", 0.0},
                                                                           {"acosh(q)", -2.0},
                                                                           {"abs(q)", 0.0}}) {
    const BallJet jet =
        Written("coordinate q\nmomentum p\nH = p^2/2 + " + term + "\n").at(point({q, 1.0}));
    EXPECT_FALSE(jet.value.is_finite() && jet.gradient.at(0).is_finite()) << term;
  }
}

// Over a box everything encloses what it is at points of the box.
TEST(BallJet, OverABoxEnclosesThatAtItsPoints) {
  const Written written("coordinate q\nmomentum p\nH = p^2/2*exp(q) - atan2(p, q)/q + q^p\n");
  const Ball radius(0.125, kJetBits);
  std::vector<Ball> box = point({1.0, 2.0});
  for (Ball& side : box) side = side.widened(radius);
  const BallJet wide = written.at(box);
  for (const double x : {-0.125, 0.0, 0.1}) {
    for (const double y : {-0.1, 0.125}) {
      const BallJet inside = written.at(point({1.0 + x, 2.0 + y}));
      EXPECT_TRUE((wide.value - inside.value).contains_zero());
      for (const auto& [i, entry] : wide.gradient)
        EXPECT_TRUE((entry - inside.gradient.at(i)).contains_zero()) << i;
      for (const auto& [place, entry] : wide.hessian)
        EXPECT_TRUE((entry - inside.hessian.at(place)).contains_zero());
    }
  }
  const BallJet outside = written.at(point({2.0, 2.0}));
  EXPECT_FALSE((wide.gradient.at(1) - outside.gradient.at(1)).contains_zero());
}

}  // namespace
}  // namespace hamgen::certify_test
