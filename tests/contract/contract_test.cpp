// Every step that an emitted Propagator takes solves its equations to rounding, also where a smooth
// motion meets a wall: Note [contract of a solve] in step_defect.hpp.
#include <gtest/gtest.h>

#include "tests/contract/measure.hpp"

namespace hamgen::contract {
namespace {

struct Method {
  std::string name;
  Request request;
  std::string alpha = "1/2", beta = "0", gamma = "0";
};

std::vector<Case> cases(const std::vector<std::pair<std::string, std::string>>& scenes,
                        const Method& method, long steps) {
  std::vector<Case> result;
  for (const auto& [name, scene] : scenes) {
    result.push_back({.name = name + " " + scene + " " + method.name,
                      .model = model(name),
                      .scene = scene,
                      .request = method.request,
                      .alpha = method.alpha,
                      .beta = method.beta,
                      .gamma = method.gamma,
                      .steps = steps});
  }
  return result;
}

// All solves within the contract, and the quad steps that say so beyond doubt.
void expect_kept(const std::vector<Case>& all, double reference = 1e-9) {
  for (const Defects& d : measure(all)) {
    EXPECT_FALSE(d.failed) << d.name << " after step " << d.steps;
    EXPECT_LE(d.worst, 16) << d.name << " at step " << d.worst_step << ", " << d.broken << " of "
                           << d.solves;
    EXPECT_GE(d.solves, 150) << d.name;
    EXPECT_EQ(d.unknown, 0) << d.name;
    EXPECT_LE(d.reference, reference) << d.name;
  }
}

const std::vector<std::pair<std::string, std::string>> kWalls = {
    {"wall", "bounce"}, {"box", "soft"}, {"morse_approach", "far"}, {"lennard_jones", "slow"}};

TEST(Contract, NewtonKeepsItAtEveryWall) {
  std::vector<Case> all = cases(kWalls, {"newton", {}}, 1500);
  for (const Case& more : cases(
           {{"box", "fast"}, {"hard_box", "fine"}, {"wobble", "coarse"}, {"lennard_jones", "fast"}},
           {"newton", {}}, 1500)) {
    all.push_back(more);
  }
  expect_kept(all);
}

// Also where it contracts by 0.9 a time, with either sign.
TEST(Contract, AFixedPointKeepsIt) {
  const Method method{"fixed-point", {.solver = "fixed-point"}};
  std::vector<Case> all = cases(kWalls, method, 700);
  for (const Case& slow : cases({{"swing", "below"}, {"swing", "above"}}, method, 700)) {
    all.push_back(slow);
  }
  expect_kept(all);
}

TEST(Contract, AGeneralMemberKeepsIt) {
  expect_kept(cases(
      kWalls,
      {"member", {.alpha = "3/10", .beta = "1/5", .gamma = "-1/10"}, "3/10", "1/5", "-1/10"}, 700));
}

// Each of its substeps.
TEST(Contract, ACompositionKeepsIt) {
  expect_kept(cases(kWalls, {"yoshida-4", {.scheme = "yoshida-4"}}, 700));
}

TEST(Contract, GaussKeepsItByEitherSolver) {
  std::vector<Case> all = cases(kWalls, {"gauss-4", {.scheme = "gauss-4"}}, 500);
  for (const Case& more :
       cases({{"wall", "bounce"}, {"box", "soft"}},
             {"gauss-4 newton", {.scheme = "gauss-4", .solver = "newton"}}, 500)) {
    all.push_back(more);
  }
  expect_kept(all);
}

// Of a member of higher order the equations are K's, whose gradient is rounded in more operations
// than H's; the Hessian of K is approximated.
TEST(Contract, SimplifiedNewtonKeepsIt) {
  expect_kept(cases(kWalls, {"order 4", {.order = 4}}, 700), 1e300);
}

TEST(Contract, OtherScalarsKeepIt) {
  std::vector<Case> all;
  for (const char* scalar : {"float", "long-double"}) {
    for (const Case& c : cases({{"wall", "bounce"}, {"box", "soft"}, {"lennard_jones", "fast"}},
                               {scalar, {.scalar = scalar}}, 1000)) {
      all.push_back(c);
    }
  }
  expect_kept(all);
}

TEST(Contract, SumsInLoopsKeepIt) {
  expect_kept(cases({{"beads", "shot"}}, {"newton", {}}, 150));
  expect_kept(cases({{"beads", "shot"}}, {"fixed-point", {.solver = "fixed-point"}}, 150));
}

// In a hard box the polynomial of the stages before leads where no iteration comes back from; the
// state itself does not.
TEST(Contract, GaussTriesAgainFromTheStateItself) {
  const std::vector<Case> all = cases(
      {{"hard_box", "coarse"}}, {"gauss-8", {.scheme = "gauss-8", .solver = "fixed-point"}}, 0);
  expect_kept(all);
  const Defects once = measure(all, [](std::string text) {
                         const std::string again = "if (!report.converged && known)";
                         const auto at = text.find(again);
                         EXPECT_NE(at, std::string::npos);
                         return text.replace(at, again.size(), "if (false)");
                       }).at(0);
  EXPECT_TRUE(once.failed);
}

// The negative control: the rule without the look at the motion, which learns its contraction in
// free flight and believes it at the wall.
TEST(Contract, ARuleThatOnlyRemembersBreaksIt) {
  const auto forget_the_motion = [](std::string text) {
    const std::string look = "previous > 0 || is_straight(size, round_off)";
    const auto at = text.find(look);
    EXPECT_NE(at, std::string::npos);
    return at == std::string::npos ? text : text.replace(at, look.size(), "true");
  };
  for (const Defects& d : measure(cases({{"wall", "bounce"}, {"box", "soft"}}, {"newton", {}}, 700),
                                  forget_the_motion)) {
    EXPECT_GE(d.worst, 1e6) << d.name;
    EXPECT_GE(d.broken, 1) << d.name;
  }
}

}  // namespace
}  // namespace hamgen::contract
