// Which steps have the derivatives of the next one evaluated ahead.
#include <gtest/gtest.h>

#include "tests/planner/emitted_text.hpp"

namespace hamgen::planner_test {
namespace {

const Request midpoint_rule{.scheme = "implicit-midpoint"};

// One unknown, and functions or roots of nothing else.
TEST(Ahead, WhatWaitsForAFunctionHasItsDerivativesAhead) {
  const auto ahead = [](const std::string& text, const Request& request = midpoint_rule) {
    const Outcome found = outcome(text, request);
    const bool planned = contains(found.plan, "derivatives ahead\n");
    EXPECT_EQ(contains(found.header, "struct Derivatives"), planned) << found.header;
    EXPECT_EQ(contains(found.header, "; derivatives ahead"), planned) << found.header;
    return planned;
  };
  const std::string potentials[] = {"cos(q)", "exp(-q)", "sqrt(1 + q^2)", "(1 + q^2)^(1/3)",
                                    "q^64/64"};
  for (const std::string& potential : potentials)
    EXPECT_TRUE(ahead(one + "H = p^2/2 + " + potential + "\n")) << potential;
  EXPECT_TRUE(ahead(one + "parameter m = 2\nH = p^2/(2*m) - m*cos(q)\n"));
  EXPECT_TRUE(ahead(one + "H = p^2/2 - cos(q)\n", {.alpha = "3/10", .beta = "h/7"}));
  // Polynomials of small degree and quotients are quick, and parameters are known before the step.
  EXPECT_FALSE(ahead(one + "H = p^2/2 + q^4/4\n"));
  EXPECT_FALSE(ahead(one + "H = p^2/2 + q^16/16\n"));
  EXPECT_FALSE(ahead(one + "H = p^2/2 + 1/q\n"));
  EXPECT_FALSE(ahead(one + "H = p^2/2 + abs(q)^3\n"));
  EXPECT_FALSE(ahead(one + "parameter a = 1\nH = p^2/2 + exp(a)*q^4/4\n"));
  // A function of what the unknown is not.
  EXPECT_FALSE(ahead(one + "time t\nH = p^2/2 + (1 + cos(t)/5)*q^4/4\n"));
  EXPECT_FALSE(ahead(one + "time t\nH = p^2/2 - cos(q - t)\n"));
  // More unknowns.
  EXPECT_FALSE(ahead(one + "H = cosh(p) - cos(q)\n"));
  EXPECT_FALSE(ahead(two + "H = p1^2/2 + p2^2/2 - cos(q1) - cos(q1 - q2)\n"));
  EXPECT_FALSE(ahead(two + "H = p1^2/2 - cos(q1) + p2^2/2 - cos(q2)\n"));
  // Others than a member's own step.
  const std::string pendulum = one + "H = p^2/2 - cos(q)\n";
  EXPECT_FALSE(ahead(pendulum, {.solver = "fixed-point"}));
  EXPECT_FALSE(ahead(pendulum, {.solver = "sweeps:3"}));
  EXPECT_FALSE(ahead(pendulum, {.scheme = "gauss-4"}));
  EXPECT_FALSE(ahead(pendulum, {.scheme = "stormer-verlet"}));
  EXPECT_FALSE(ahead(one + "H = p^2/2 - cos(q)*(1 + p^2)\n", {.scheme = "yoshida-4"}));
  EXPECT_FALSE(ahead(pendulum, {.order = 4}));
}

// They are those of one trajectory: lanes wait for no function of their own alone.
TEST(Ahead, ABatchHasItsDerivativesWhereTheyAreWanted) {
  Request batch = midpoint_rule;
  batch.batch = 4;
  const Outcome found = outcome(one + "H = p^2/2 - cos(q)\n", batch);
  EXPECT_FALSE(contains(found.header, "Derivatives")) << found.header;
  EXPECT_FALSE(contains(found.header, "derivatives ahead")) << found.header;
}

}  // namespace
}  // namespace hamgen::planner_test
