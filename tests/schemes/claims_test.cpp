// What a scheme says of itself, and the systems and orders that it refuses.
#include <gtest/gtest.h>

#include <string>

#include "generator/base/diagnostic.hpp"
#include "generator/pipeline.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/schemes/coefficients.hpp"

namespace hamgen::schemes_test {
namespace {

GaugeBlock same_for_all(const Expression& value) { return {.entries = {value}}; }

std::string name_of_member(const Expression& alpha, const Expression& beta,
                           const Expression& gamma) {
  return family_member(1, same_for_all(alpha), same_for_all(beta), same_for_all(gamma)).name;
}

TEST(Members, HaveTheNameOfAMethodOnlyIfAllOfCIsTheMethods) {
  const Expression zero(0);
  const Expression one(1);
  const Expression h = Expression::symbol("h");
  EXPECT_EQ(name_of_member(ratio(1, 2), zero, zero), "implicit-midpoint");
  EXPECT_EQ(name_of_member(zero, zero, zero), "symplectic-euler-a");
  EXPECT_EQ(name_of_member(one, zero, zero), "symplectic-euler-b");
  for (const Expression& alpha : {zero, one, ratio(1, 2)}) {
    EXPECT_EQ(name_of_member(alpha, h, zero), "member");
    EXPECT_EQ(name_of_member(alpha, zero, h), "member");
  }
}

TEST(Members, ThatCoupleDegreesOfFreedomHaveNoParametersForAll) {
  for (const Expression& alpha : {Expression(0), Expression(1), ratio(1, 3)}) {
    const auto member = [&](const Expression& coupling) {
      const GaugeBlock block{.entries = {alpha, coupling, Expression(0), alpha}, .is_matrix = true};
      return family_member(2, block, same_for_all(ratio(1, 5)), same_for_all(ratio(1, 7)));
    };
    const auto uniform = uniform_parameters(member(Expression(0)).member());
    ASSERT_TRUE(uniform);
    EXPECT_EQ(uniform->alpha, alpha);
    EXPECT_EQ(uniform->beta, ratio(1, 5));
    EXPECT_EQ(uniform->gamma, ratio(1, 7));
    EXPECT_FALSE(uniform_parameters(member(ratio(1, 9)).member()));
  }
}

// The step of the kick is not that of the drift in reverse, though each list is.
TEST(Splittings, AreSymmetricIfKicksAndDriftsAreTheSameInReverse) {
  const Expression half = ratio(1, 2);
  EXPECT_TRUE(is_symmetric({.kick_first = true, .kicks = {half, half}, .drifts = {1}}));
  EXPECT_FALSE(is_symmetric({.kick_first = true, .kicks = {1}, .drifts = {1}}));
  EXPECT_FALSE(is_symmetric({.kick_first = false, .kicks = {half, half}, .drifts = {half, half}}));
  EXPECT_FALSE(
      is_symmetric({.kick_first = true, .kicks = {ratio(1, 3), ratio(2, 3)}, .drifts = {1}}));
}

// c h is a pole of the base.
TEST(Compositions, HaveThePolesOfTheirSubsteps) {
  const Scheme scheme{.method =
                          Composition{.base = {.degrees_of_freedom = 1, .singular_steps = {2, 5}},
                                      .substeps = {ratio(4, 1), ratio(-7, 1), ratio(4, 1)}}};
  EXPECT_EQ(singular_steps(scheme), (std::vector<double>{2.0 / 7, 0.5, 5.0 / 7, 1.25}));
}

std::string refusal_of_step(const std::string& model, const Request& request) {
  try {
    (void)show_stage(make_source("m.ham", "system m\n" + model), request, "plan");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Nystrom, MethodsRefuseAKineticEnergyThatIsNotQuadratic) {
  const std::string two = "coordinate x, y\nmomentum px, py\nH = x^4 + y^2 + ";
  const Request nystrom{.scheme = "blanes-moan-rkn-4"};
  for (const char* fine : {"px^2 + px*py + py^2/3", "px*py", "(px + 2*py)^2 + px"})
    EXPECT_EQ(refusal_of_step(two + fine + "\n", nystrom), "accepted") << fine;
  for (const char* more : {"px^2 + py^4", "px*py^2", "px^2*py^2", "cosh(px) + py^2", "px^3 + py^2"})
    EXPECT_NE(refusal_of_step(two + more + "\n", nystrom).find("needs a T(p) that is quadratic"),
              std::string::npos)
        << more;
}

// The terms of a symmetric member's error have odd powers of h.
TEST(RaisedOrder, OfASymmetricMemberIsEven) {
  const Expression zero(0);
  const auto member = [&](const Expression& alpha) {
    return family_member(1, same_for_all(alpha), same_for_all(zero), same_for_all(zero));
  };
  for (int order = 3; order <= kHighestOrder; ++order) {
    EXPECT_EQ(raise_order(member(zero), order).order, order);
    const auto raised = [&] { return raise_order(member(ratio(1, 2)), order).order; };
    if (order % 2 == 0) {
      EXPECT_EQ(raised(), order);
    } else {
      EXPECT_THROW((void)raised(), UsageError) << order;
    }
  }
}

}  // namespace
}  // namespace hamgen::schemes_test
