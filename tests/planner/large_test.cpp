// Systems too large to write out keep their sums as loops, from the model to the emitted text.
#include <gtest/gtest.h>

#include "tests/planner/emitted_text.hpp"

namespace hamgen::planner_test {
namespace {

std::string chain(int n,
                  const std::string& potential = "(q[i+1] - q[i])^2/2 + (q[i+1] - q[i])^3/12") {
  return "size N = " + std::to_string(n) +
         "\ncoordinate q[1..N] with q[0] = 0, q[N+1] = 0\nmomentum p[1..N]\n"
         "H = sum(i = 1..N, p[i]^2/2) + sum(i = 0..N, " +
         potential + ")\n";
}

TEST(LargePlan, TheTextOfALongSumDoesNotGrowWithItsLength) {
  for (const Request& request : {Request{}, Request{.alpha = "0"}, Request{.alpha = "1"},
                                 Request{.alpha = "3/10", .beta = "h/7", .gamma = "-h/9"}}) {
    const Outcome forty = outcome(chain(40), request);
    const Outcome thousand = outcome(chain(1000), request);
    EXPECT_TRUE(contains(forty.plan, "stay loops")) << forty.plan;
    // Only numbers differ: 1000 has two digits more than 40 wherever the size is said.
    EXPECT_LT(thousand.header.size(), forty.header.size() + 400);
    EXPECT_FALSE(contains(forty.header, "q[17]"));
  }
}

TEST(LargePlan, EulerOnALongChainIsExplicitLoops) {
  for (const char* alpha : {"0", "1"}) {
    const Outcome small = outcome(chain(64), {.alpha = alpha});
    EXPECT_TRUE(contains(small.plan, "solver: explicit, in loops\n")) << small.plan;
    EXPECT_FALSE(contains(small.header, "Verdict"));
    EXPECT_FALSE(contains(small.header, "Eigen/"));
  }
}

TEST(LargePlan, TheMidpointRuleOnALongChainIsNewtonOfSizeN) {
  const Outcome small = outcome(chain(64));
  EXPECT_TRUE(contains(small.plan, "Newton of size 64")) << small.plan;
  EXPECT_TRUE(contains(small.plan, "momenta torn out")) << small.plan;
}

TEST(LargePlan, AHarmonicChainIsFactorisedOnce) {
  const Outcome small = outcome(chain(64, "(q[i+1] - q[i])^2/2"));
  EXPECT_TRUE(contains(small.plan, "linear solve of size 64")) << small.plan;
  EXPECT_TRUE(contains(small.plan, "factorised once")) << small.plan;
  EXPECT_FALSE(contains(small.plan, "Newton")) << small.plan;
}

TEST(LargePlan, ParametersPerDegreeOfFreedomAndOtherSolversWriteTheSumOut) {
  std::string list = "1/2";
  for (int i = 1; i < 30; ++i) list += ",1/2";
  EXPECT_FALSE(contains(outcome(chain(30), {.alpha = list}).plan, "stay loops"));
  EXPECT_FALSE(contains(outcome(chain(30), {.solver = "fixed-point"}).plan, "stay loops"));
}

}  // namespace
}  // namespace hamgen::planner_test
