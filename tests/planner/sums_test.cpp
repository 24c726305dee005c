// Whether sums are written out or stay loops is decided by what a step costs, not by a size.
#include <gtest/gtest.h>

#include "generator/base/source_text.hpp"
#include "generator/choose_sums.hpp"
#include "tests/planner/emitted_text.hpp"
#include "tests/specialise/specialised_request.hpp"

namespace hamgen::planner_test {
namespace {

std::string chain_of(int n) {
  return "size N = " + std::to_string(n) +
         "\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
         "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, (q[i+1] - q[i])^2/2 + (q[i+1] - "
         "q[i])^3/12)\n";
}

SourceText shipped(const std::string& name) {
  return read_source(std::string(HAMGEN_SOURCE_DIR "/hamiltonians/") + name + ".ham");
}

bool stays_loops(const SourceText& source, const Request& request = {}) {
  return contains(show_stage(source, request, "plan"), "sums stay loops");
}

TEST(Sums, StayLoopsWhereAMatrixIsMoreWorkThanTheFixedPoint) {
  for (const int n : {2, 3, 4, 5}) EXPECT_FALSE(stays_loops(model(chain_of(n)))) << n;
  for (const int n : {8, 12, 24, 25}) EXPECT_TRUE(stays_loops(model(chain_of(n)))) << n;
  for (const char* name : {"outer_solar_system", "figure_eight", "pythagorean", "beads", "phi4"})
    EXPECT_TRUE(stays_loops(shipped(name))) << name;
  for (const char* name : {"pendulum", "henon_heiles", "kepler", "toda", "two_bodies", "stiff_fpu"})
    EXPECT_FALSE(stays_loops(shipped(name))) << name;
}

// Only numbers differ, and a word where the last of them has a digit more.
TEST(Sums, OfAChainAreTheSameCodeOnBothSidesOfTwentyFour) {
  const Outcome shorter = outcome(chain_of(24));
  const Outcome longer = outcome(chain_of(25));
  EXPECT_EQ(count(shorter.header, "\n"), count(longer.header, "\n"));
  EXPECT_TRUE(contains(shorter.plan, "banded Newton of size 24 where it contracts slowly"))
      << shorter.plan;
}

// They share its State, so that headers of two methods meet in one program.
TEST(Sums, AreOfOneFormForAllMethodsOfASystem) {
  for (const Request& request :
       {Request{.scheme = "stormer-verlet"}, Request{.scheme = "gauss-8"}, Request{.alpha = "0"},
        Request{.scheme = "yoshida-4"}, Request{.solver = "newton"},
        Request{.solver = "fixed-point"}, Request{.solver = "sweeps:2"}}) {
    EXPECT_TRUE(stays_loops(model(chain_of(12)), request));
    EXPECT_FALSE(stays_loops(model(chain_of(4)), request));
  }
}

TEST(Sums, AreWrittenOutForWhatIsMadeOfExpressions) {
  std::string list = "1/2";
  for (int i = 1; i < 12; ++i) list += ",1/2";
  for (const Request& request :
       {Request{.alpha = list}, Request{.order = 4}, Request{.gauge = "locally-exact"},
        Request{.scheme = "stormer-verlet", .format = "c-header"}, Request{.tangent = true},
        Request{.watch_modified = 2, .step = Rational(1, 10)}}) {
    EXPECT_FALSE(stays_loops(model(chain_of(12)), request));
  }
}

// Loops leave out whole arrays only; half of these beads move as the other half does.
TEST(Sums, OfASceneThatNeedsFewerDegreesOfFreedomAreWrittenOut) {
  const SourceText beads = shipped("beads");
  EXPECT_FALSE(stays_loops(beads, for_scene(beads, {.scene = "plucked"})));
}

TEST(Sums, TheStateOfLoopsSaysWhoseElementsStandWhere) {
  const std::string header = emit(shipped("outer_solar_system"), {})[0].text;
  EXPECT_TRUE(contains(header, "  Real q[18] = {};  // x[0..5], y[0..5], z[0..5]\n"));
  EXPECT_TRUE(contains(header, "  Real p[18] = {};  // px[0..5], py[0..5], pz[0..5]\n"));
}

TEST(Sums, InFunctionsAreWrittenOutForWhatHasAllSecondDerivatives) {
  EXPECT_EQ(wish_for_all_second_derivatives({}), "");
  EXPECT_EQ(wish_for_all_second_derivatives({.solver = "fixed-point"}), "");
  EXPECT_EQ(wish_for_all_second_derivatives({.tangent = true}), "the tangent map");
  EXPECT_EQ(wish_for_all_second_derivatives({.order = 4}), "a step of higher order");
  EXPECT_EQ(wish_for_all_second_derivatives({.solver = "newton"}), "Newton's method");
}

}  // namespace
}  // namespace hamgen::planner_test
