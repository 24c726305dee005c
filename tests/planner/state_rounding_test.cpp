// Near zero, where forces cancel, the state is rounded with lengths that hang on the step.
#include <gtest/gtest.h>

#include "tests/planner/emitted_text.hpp"

namespace hamgen::planner_test {
namespace {

std::string lattice(const std::string& mass) {
  return "coordinate q[1..3] periodic\nmomentum p[1..3]\nH = sum(i = 1..3, " + mass +
         "*p[i]^2 + exp(q[i] - q[i+1]))\n";
}

// Coordinates by what rounds the force, answered by h/2 times h/2 over the mass; momenta by what
// moves those as far in half a step.
TEST(StateRounding, OfMomentaMovesCoordinatesByTheirsInHalfAStep) {
  const Request request{.scheme = "gauss-4", .solver = "newton"};
  const std::string one = outcome(lattice("1/2"), request).header;
  EXPECT_TRUE(contains(one, "  k.beside_q = 0.5 * (h * h) / (1.0 + 0.5 * (h * h));\n"));
  EXPECT_TRUE(contains(one, "  k.beside_p = std::fabs(h / (1.0 + 0.5 * (h * h)));\n"));
  // A mass of 1/4: those of q are four times as large, of p as those of q over 2 h.
  const std::string quarter = outcome(lattice("2"), request).header;
  EXPECT_TRUE(contains(quarter, "  k.beside_q = 2.0 * (h * h) / (1.0 + 2.0 * (h * h));\n"));
  EXPECT_TRUE(contains(quarter, "  k.beside_p = std::fabs(h / (1.0 + 2.0 * (h * h)));\n"));
}

TEST(StateRounding, OfMomentaThatAreTornOutIsNone) {
  const std::string torn = outcome(lattice("1/2"), {.scheme = "gauss-4"}).header;
  EXPECT_TRUE(contains(torn, "k.beside_q = "));
  EXPECT_FALSE(contains(torn, "beside_p"));
}

}  // namespace
}  // namespace hamgen::planner_test
