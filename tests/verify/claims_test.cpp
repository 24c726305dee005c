// What is proved is true and what is refuted is false: claims that algebra alone gets wrong.
#include <gtest/gtest.h>

#include <algorithm>

#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "generator/pipeline.hpp"
#include "generator/verify/identities.hpp"
#include "generator/verify/linear_stability.hpp"
#include "generator/verify/zero_by_algebra.hpp"

namespace hamgen {
namespace {

SourceText shipped(const std::string& name) {
  return read_source(HAMGEN_SOURCE_DIR "/hamiltonians/" + name + ".ham");
}

// Two particles on a line: their total momentum is linear, its square quadratic.
SourceText pair() {
  return make_source("pair.ham",
                     "coordinate x, y\nmomentum u, v\n"
                     "H = u^2/2 + v^2/2 + (x - y)^2 + (x - y)^4/4\n"
                     "invariant P = u + v\ninvariant Square = (u + v)^2\n"
                     "invariant Product = u*v\ninvariant Distance = x - y\n");
}

Verdict verdict(const SourceText& source, const Request& request, const std::string& property) {
  const Proof proof = verify_step(source, request);
  const auto found = std::ranges::find(proof, property, &Finding::property);
  EXPECT_NE(found, proof.end()) << property;
  return found == proof.end() ? Verdict::not_decided : found->verdict;
}

// Where no sample lies in the domain, algebra is alone: powers that add up to -1, and to -2^32, of
// which neither is its inverse.
TEST(Claims, AreNotProvedOfPowersThatAreAnothers) {
  const auto named = [](const char* name) { return Expression::symbol(name); };
  const Expression x = named("x"), y = named("y"), z = named("z"), a = named("a"), b = named("b");
  const Expression far = Expression(Rational(1000000));
  const Expression w = Expression::power(x + y - far, Expression(Rational(1, 2)));
  const Expression one = a / (a + b) + b / (a + b);
  const Expression inverse = Expression::power(w * z, -one);
  EXPECT_FALSE(is_zero_by_algebra(inverse - w / z));
  EXPECT_TRUE(is_zero_by_algebra(inverse - Expression(1) / (w * z)));
  const auto third = [&](int k) { return Expression::power(w * z, Expression(Rational(k, 3))); };
  const Expression sum = (third(1) + Expression(1)) * (third(-4) + Expression(1)) - third(1) -
                         third(-4) - Expression(1);  // (w z)^-1
  EXPECT_FALSE(is_zero_by_algebra(sum - w / z));
  const Expression large(65536);
  const Expression small =
      (y + Expression(1)) / Expression::power(x, large) - y / Expression::power(x, large);
  EXPECT_FALSE(is_zero_by_algebra(Expression::apply("log", {x - far}) *
                                  (Expression::power(small, large) - Expression(1))));
}

// sin(x - y) and sin(y - x), each written as the ranks of its own symbols order them.
TEST(Claims, DoNotDependOnTheRanksOfSymbols) {
  const auto sine = [](const Expression& x, const Expression& y) {
    return Expression::apply("sin", {x - y});
  };
  const Expression forwards = sine(Expression::symbol("x", 1), Expression::symbol("y", 2));
  const Expression backwards = sine(Expression::symbol("y", 1), Expression::symbol("x", 2));
  EXPECT_TRUE(is_zero_by_algebra(forwards + backwards));
  EXPECT_FALSE(is_zero_by_algebra(forwards - backwards));
}

TEST(Claims, OfAnInvariantAreProvedOrRefutedByAPoint) {
  EXPECT_EQ(verdict(pair(), {}, "P invariant"), Verdict::proved);
  EXPECT_EQ(verdict(pair(), {}, "Square invariant"), Verdict::proved);
  EXPECT_EQ(verdict(pair(), {}, "Product invariant"), Verdict::refuted);
  EXPECT_EQ(verdict(pair(), {}, "Distance invariant"), Verdict::refuted);
  EXPECT_EQ(verdict(shipped("stiff_fpu"), {}, "I invariant"), Verdict::refuted);
}

// A polynomial of higher degree is not taken for a quadratic form, whatever its second derivatives
// at a point are: here H itself, which no member conserves.
TEST(Claims, AQuarticInvariantIsNotAQuadraticForm) {
  const SourceText source = make_source("quartic.ham",
                                        "coordinate q\nmomentum p\nH = p^2/2 + q^4/4\n"
                                        "invariant I = p^2/2 + q^4/4\n");
  for (const char* scheme : {"implicit-midpoint", "gauss-4", "stormer-verlet", "kahan-li-6"}) {
    EXPECT_EQ(verdict(source, {.scheme = scheme}, "I conserved by the step"), Verdict::not_decided)
        << scheme;
  }
}

// C^T M + M C = 0 is enough for every H; for one it is not needed.
TEST(Claims, ThatAQuadraticInvariantIsLostHaveAWitnessOfThisSystem) {
  const Request general{.alpha = "3/10", .beta = "1/10"};
  EXPECT_EQ(verdict(pair(), general, "P conserved by the step"), Verdict::proved);
  EXPECT_EQ(verdict(pair(), general, "Square conserved by the step"), Verdict::proved);
  // A rotor whose radius is no constant: beta turns q into p.
  const SourceText rotor = make_source(
      "rotor.ham",
      "coordinate q\nmomentum p\nH = (q^2 + p^2)^2/4 + q^2 + p^2\ninvariant R = q^2 + p^2\n");
  EXPECT_EQ(verdict(rotor, {}, "R conserved by the step"), Verdict::proved);
  EXPECT_EQ(verdict(rotor, {.beta = "1/10", .gamma = "-1/10"}, "R conserved by the step"),
            Verdict::proved);
  EXPECT_EQ(verdict(rotor, {.beta = "1/10"}, "R conserved by the step"), Verdict::refuted);
  EXPECT_EQ(verdict(rotor, {.alpha = "3/10"}, "R conserved by the step"), Verdict::refuted);
}

TEST(Claims, AboutInvariantsAreMadeForEveryKindOfMethod) {
  const std::string property = "L conserved by the step";
  for (const char* scheme : {"stormer-verlet", "gauss-4", "yoshida-4"}) {
    EXPECT_EQ(verdict(shipped("kepler"), {.scheme = scheme}, property), Verdict::proved) << scheme;
  }
  EXPECT_EQ(verdict(shipped("kepler"), {.scheme = "rk4"}, property), Verdict::not_decided);
  EXPECT_EQ(verdict(shipped("kepler"), {.solver = "sweeps:2"}, property), Verdict::not_decided);
  EXPECT_EQ(verdict(pair(), {.scheme = "rk4"}, "P conserved by the step"), Verdict::proved);
  EXPECT_EQ(verdict(pair(), {.solver = "sweeps:2"}, "P conserved by the step"), Verdict::proved);
}

TEST(Claims, OfAnOrderNeedAPowerSeriesOfC) {
  for (const char* beta : {"sqrt(abs(h))", "abs(h)^(1/10)", "abs(h)", "sqrt(h^2)", "h*log(h)"}) {
    EXPECT_EQ(verdict(shipped("pendulum"), {.beta = beta}, "order"), Verdict::not_decided) << beta;
    EXPECT_THROW((void)generate(shipped("pendulum"), {.beta = beta, .order = 4}), UsageError)
        << beta;
  }
  // These have one.
  for (const char* beta : {"h*sqrt(1 + h^2)", "h*abs(1 - h)", "tan(h)", "h*log(1 + h)"}) {
    EXPECT_EQ(verdict(shipped("pendulum"), {.beta = beta}, "order 2"), Verdict::proved) << beta;
  }
}

TEST(Claims, OfSymmetryAreNotRefutedByAZeroThatAlgebraMisses) {
  const Request hidden{.alpha = "1/2 + sin(h)^2 + cos(h)^2 - 1"};
  EXPECT_EQ(verdict(shipped("pendulum"), hidden, "symmetric"), Verdict::tested);
  EXPECT_EQ(verdict(shipped("pendulum"), {.alpha = "1/2 + h^2"}, "symmetric"), Verdict::refuted);
}

TEST(Claims, OfAGaugeAreNotRefutedByAZeroThatAlgebraMisses) {
  const Request hidden{.gauge = "[[sin(h)^2 + cos(h)^2 - 1, h], [h/3, 0]]"};
  EXPECT_EQ(verdict(shipped("pendulum"), hidden, "gauge in sp(2n)"), Verdict::tested);
  EXPECT_EQ(verdict(shipped("pendulum"), hidden, "symplectic"), Verdict::tested);
  const std::string header = generate(shipped("pendulum"), hidden).front().text;
  EXPECT_EQ(header.find("not symplectic"), std::string::npos);
  const Request none{.gauge = "[[sin(h)^2 + cos(h)^2 - 1, h], [h/3, h^9]]"};
  EXPECT_EQ(verdict(shipped("pendulum"), none, "gauge in sp(2n)"), Verdict::refuted);
  EXPECT_EQ(verdict(shipped("pendulum"), none, "symplectic"), Verdict::refuted);
}

TEST(Claims, OfAModifiedHamiltonianNeedASolvedStep) {
  EXPECT_THROW((void)modified_hamiltonian(shipped("pendulum"), {.solver = "sweeps:2"}, 2),
               UsageError);
  EXPECT_THROW((void)generate(shipped("pendulum"), {.solver = "sweeps:2", .watch_modified = 2}),
               UsageError);
}

LinearStability at_initial_state(const SourceText& source, const std::string& scene,
                                 const Request& request) {
  const Model model = read_model(source);
  const auto points = linear_points(source, request, scene_values(model, {.scene = scene}));
  EXPECT_FALSE(points.empty());
  return points.front().stability;
}

// x*v - y*u turns both planes with w = 1, and (x^2 + y^2)/2 couples them: the flow grows like t.
TEST(Claims, OfBoundednessNeedEigenvectorsForADoubleFrequency) {
  const auto rotation = [](const std::string& more) {
    return make_source("rotation.ham", "coordinate x, y\nmomentum u, v\nH = x*v - y*u" + more +
                                           "\nscene s {\n  x = 1/2\n  h = 1/5\n  steps = 10\n}\n");
  };
  for (const Request& request :
       {Request{}, Request{.scheme = "gauss-4"}, Request{.alpha = "2/5"}}) {
    const LinearStability grows = at_initial_state(rotation(" + (x^2 + y^2)/2"), "s", request);
    EXPECT_TRUE(grows.resonant);
    EXPECT_EQ(grows.verdict, Verdict::not_decided);
  }
  const LinearStability turns = at_initial_state(rotation(""), "s", {});
  EXPECT_FALSE(turns.resonant);
  EXPECT_EQ(turns.verdict, Verdict::proved);
}

TEST(Claims, OfFrequenciesAreNotMadeOfRounding) {
  const LinearStability horizontal = at_initial_state(shipped("double_pendulum"), "horizontal", {});
  EXPECT_TRUE(horizontal.frequencies.empty());
  EXPECT_EQ(horizontal.free_motions, 2);
}

}  // namespace
}  // namespace hamgen
