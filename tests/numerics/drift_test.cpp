// What exact arithmetic keeps must not drift by rounding: its error walks at random.  Every row
// here is short, benchmarks/drift has all methods and storages.
//
// A step of exact arithmetic changes nothing, one of rounded numbers changes the quantity I by
// errors of which the sum after N steps has some mean and, from start to start, a deviation of
// about sqrt(N) times that of one.  With 8 starts the mean lies within 4 of its standard errors
// in 99.5 of 100 cases (Student's t with 7 degrees of freedom), but starts and arithmetic are fixed
// here: a row passes always or never.  A bias of 1e-4 units of rounding a step is allowed besides,
// so that a row whose walk is short by accident does not fail.  What the mutants show is ten times
// that and more.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "benchmarks/drift/rows.hpp"

namespace hamgen::drift {
namespace {

constexpr long long kSteps = 200'000;
constexpr int kStarts = 8;

struct Replacement {
  std::string old_text, new_text;
};

// Every place of it; there is one at least.
std::string replaced(std::string text, const Replacement& r) {
  std::size_t place = text.find(r.old_text);
  if (place == std::string::npos) throw std::runtime_error("not in the header: " + r.old_text);
  for (; place != std::string::npos; place = text.find(r.old_text, place + r.new_text.size())) {
    text.replace(place, r.old_text.size(), r.new_text);
  }
  return text;
}

struct Short {
  long long steps = kSteps;
  int starts = kStarts;
};
Result result_of(const Row& row, const std::vector<Replacement>& edits = {},
                 const Short& length = {}) {
  const auto edit = [&](std::string header) {
    for (const Replacement& each : edits) header = replaced(std::move(header), each);
    return header;
  };
  // The same bits by any optimisation, and the compiler takes less time.
  return measure(row, {.steps = length.steps, .starts = length.starts, .seconds = 1e9}, edit,
                 {"-O1"});
}

std::string words(const Result& result) {
  return "mean " + std::to_string(result.units()) + " units of rounding a step, " +
         std::to_string(result.mean / result.standard_error) + " standard errors, own rates " +
         std::to_string(result.own_rate);
}

// The row does not drift, and what the edits make of its text does.
void expect_drift_only_with(const std::vector<Replacement>& edits, const Row& row,
                            const Short& length = {}) {
  const Result result = result_of(row, {}, length);
  EXPECT_FALSE(result.drifts()) << words(result);
  const Result mutant = result_of(row, edits, length);
  EXPECT_TRUE(mutant.drifts()) << words(mutant);
}

// A constant matrix is rounded alike at every step.
TEST(Drift, AnAffineBlockNeedsWhatItsEquationsLack) {
  expect_drift_only_with({{"rest.q = carry.q", "rest.q = carry.q + 0 *"},
                          {"rest.p = carry.p", "rest.p = carry.p + 0 *"}},
                         {.model = oscillator(), .request = {}, .h = 0.37}, {.starts = 32});
}

// Nothing of it is left to walk at random where all that is lost is told.
TEST(Drift, AnAffineBlockNeedsASumWithoutAnError) {
  const Row row{.model = oscillator(), .request = {}, .h = 1};
  const Result result = result_of(row);
  EXPECT_FALSE(result.drifts()) << words(result);
  const Result mutant = result_of(row, {{"carry += lost;", ""}});
  EXPECT_GT(mutant.standard_error, 100 * result.standard_error);
}

TEST(Drift, AnAffineBlockKnowsWhatTheSumOfAMomentumLost) {
  const Row row{.model = chain(2), .request = {.alpha = "3/10"}};
  const Result result = result_of(row);
  EXPECT_FALSE(result.drifts()) << words(result);
  const Result mutant =
      result_of(row, {{"- h * R_p_1 ", "- 0 * R_p_1 "}, {"- h * R_p_2 ", "- 0 * R_p_2 "}});
  EXPECT_GT(mutant.standard_error, 100 * result.standard_error);
}

// Products of a linear gradient with its constants lose a pattern.
TEST(Drift, AnAffineBlockNeedsWhatItsGradientLoses) {
  expect_drift_only_with({{"+ h * lost", "+ 0 * lost"}},
                         {.model = soft_chain(1), .request = {}, .h = 1}, {.starts = 32});
}

// Here too: what one of them leaves out walks at random, and without the way to the solution the
// step drifts by a tenth of a rounding error.
TEST(Drift, LinearEquationsInLoopsNeedWhatGradientsSumsAndDifferencesLose) {
  const Row row{.model = chain(25), .request = {}, .h = 1};
  const Short length{.steps = 20'000};
  const Result result = result_of(row, {}, length);
  EXPECT_FALSE(result.drifts()) << words(result);
  for (const Replacement& edit : {Replacement{"lost[i] = -(left[i] + lost[i])", "lost[i] = 0"},
                                  Replacement{"= difference_error(", "= 0 * difference_error("},
                                  Replacement{"lost += error", "lost += 0 * error"}}) {
    const Result mutant = result_of(row, {edit}, length);
    EXPECT_GT(mutant.standard_error, 1e6 * result.standard_error) << edit.new_text;
  }
  const Result mutant = result_of(
      row, {{"start.moved[i] = start.lack[i]", "start.moved[i] = 0 * start.lack[i]"}}, length);
  EXPECT_TRUE(mutant.drifts()) << words(mutant);
}

// Of a large step what zbar - z loses is as much as what the equations lack.
TEST(Drift, AnAffineBlockOfALargeStepNeedsWhatDifferencesLose) {
  expect_drift_only_with({{"= difference_error(", "= 0 * difference_error("}},
                         {.model = oscillator(), .request = {}, .h = 1}, {.starts = 32});
}

TEST(Drift, AnAffineBlockNeedsWhatProductsWithHLose) {
  expect_drift_only_with({{"= product_error(", "= 0 * product_error("}},
                         {.model = oscillator(), .request = {}, .h = 0.7});
}

// The momenta are those with which the equations hold, and what the last increment adds is beside
// them: where they took it in, this row drifted by 3e-3 units.
TEST(Drift, ALargeStepOfNewtonMovesByWhatItsEquationsWereSolvedWith) {
  expect_drift_only_with({{"= rest_moving_q_1 + h * change_H_p_1", "= rest_moving_q_1"},
                          {"= rest_moving_q_2 + h * change_H_p_2", "= rest_moving_q_2"}},
                         {.model = soft_chain(5), .request = {}, .h = 1});
}

// A product that is rounded otherwise than that which moves q: each start has a rate of its own.
TEST(Drift, TheEquationsHaveTheProductThatMovesTheStep) {
  std::vector<Replacement> edits;
  for (int i = 1; i <= 2; ++i) {
    edits.push_back({fmt::format("q_{0}_gap + p_{0}_bar * k.c6", i),
                     fmt::format("q_{0}_gap + p_{0} * k.c7 + rest_p_{0} * k.c7", i)});
    edits.push_back({fmt::format(" + p_{}_bar * k.c9;", i), ";"});
  }
  const Row row{.model = soft_chain(2, "1"), .request = {}, .h = 1.3};
  expect_drift_only_with(edits, row);
  const Result mutant = result_of(row, edits);
  EXPECT_GT(mutant.own_rate, 1e-3);
}

// Where both are simple fractions what products lose has a pattern, and whether the digits of the
// other factor end early depends on which way the motion goes.
TEST(Drift, ConstantsOfLinearForcesAreInTwoParts) {
  expect_drift_only_with({{"= 0.9999 * par.k;", "= par.k;"}},
                         {.model = soft_chain(3, "0.9"), .request = {}, .h = 2},
                         {.steps = 1'000'000, .starts = 32});
}

TEST(Drift, AStepBesideLinearForcesIsInTwoParts) {
  expect_drift_only_with({{"= 0.9999 * h;", "= h;"}},
                         {.model = soft_chain(3, "1"), .request = {}, .h = 1.8},
                         {.steps = 500'000, .starts = 16});
}

TEST(Drift, AStepBesideLinearForcesInLoopsIsInTwoParts) {
  expect_drift_only_with({{"= 0.9999 * h;", "= h;"}},
                         {.model = soft_chain(25, "1"), .request = {}, .h = 1.8},
                         {.steps = 100'000, .starts = 16});
}

TEST(Drift, AnExplicitStageIsRoundedOnce) {
  std::vector<Replacement> edits;
  for (int i = 1; i <= 6; ++i) {
    edits.push_back({fmt::format("first_p_{0} + rest_p_{0}", i),
                     fmt::format("p_{} + (carry.p[{}] - flow_p_{})", i, i - 1, i)});
  }
  expect_drift_only_with(edits,
                         {.model = chain(6), .request = {.scheme = "symplectic-euler-a"}, .h = 0.7},
                         {.starts = 32});
}

// What rounding takes from a product with a simple fraction is a pattern.
TEST(Drift, ProductsWithWeightsComeWithTheirErrors) {
  expect_drift_only_with({{"= product_error(", "= 0 * product_error("}},
                         {.model = oscillator(), .request = {.alpha = "2/3"}, .h = 0.2});
}

TEST(Drift, TheEquationsOfLoopsStartFromTheCarry) {
  expect_drift_only_with({{"change = carry.p[i] - p_push", "change = -p_push"},
                          {"q_small = carry.q[i] + k.half_low", "q_small = k.half_low"}},
                         {.model = soft_chain(25), .request = {.solver = "newton"}},
                         {.steps = 50'000, .starts = 16});
}

// What is small goes into a sum before what is large.
TEST(Drift, WhatAProductLostComesBeforeIt) {
  expect_drift_only_with({{"= -(p_part - small)", "= carry.p[i] - p_part - p_lost"}},
                         {.model = soft_chain(25), .request = {.alpha = "3/10"}, .h = 0.3},
                         {.steps = 50'000});
}

// What a sum of h slope and the carry loses is a pattern where h is a simple fraction: seven tenths
// shows it, three tenths no more.
TEST(Drift, WhatNewtonFindsInLoopsHasTheCarryBesideIt) {
  expect_drift_only_with({{"= 0.9999 * h;", "= h;"},
                          {"dz.q[i] = k.h_high *", "dz.q[i] = carry.q[i] + k.h_high *"},
                          {"q_small = carry.q[i] + k.h_low", "q_small = k.h_low"},
                          {"dz.p[i] = -h *", "dz.p[i] = carry.p[i] - h *"},
                          {"rest.p[i] = carry.p[i]", "rest.p[i] = 0"}},
                         {.model = soft_chain(25), .request = {.solver = "newton"}, .h = 0.7});
}

// At the rounded solution what rounding takes from a gradient is not independent of the state.
TEST(Drift, NewtonInLoopsMovesByTheGradientOfItsLastIteration) {
  const std::string move = "  for (int i = 0; i < n; ++i) start.value[i] += start.lack[i];\n";
  const std::string change = "  potential_curvature(par, start.value, start.lack, start.change);\n";
  expect_drift_only_with(
      {{change + move, move + "  evaluate(par, k, z, carry, start);\n" +
                           "  for (int i = 0; i < n; ++i) start.change[i] = 0;\n"}},
      {.model = soft_chain(25), .request = {.solver = "newton"}, .h = 1},
      {.steps = 80'000, .starts = 48});
}

// Of twelfths, as h b_i are here, a sum loses a pattern.
TEST(Drift, WhatGaussStagesLackIsSummedFromTheirDifference) {
  expect_drift_only_with({{"start.small[j] +\n                 Lanes::at(k.coupling[0] + i)",
                           "start.small[j] + (\n                 Lanes::at(k.coupling[0] + i)"},
                          {"start.slope[4 * j + 2]);\n", "start.slope[4 * j + 2]));\n"}},
                         {.model = chain(6), .request = {.scheme = "gauss-6"}, .h = 0.3},
                         {.steps = 100'000});
}

// Which of two neighbours the rounded stages are depends on where they came from.
TEST(Drift, GaussStagesAreRefinedBelowTheLastPlace) {
  expect_drift_only_with({{"start.refinement.change[", "0 * start.refinement.change["}},
                         {.model = chain(6), .request = {.scheme = "gauss-4"}, .h = 0.2});
}

// The row of a momentum that is affine in itself, with a factor that is rounded alike at every
// step.
TEST(Drift, ATornMomentumIsSolvedForWhatItsRowLacks) {
  expect_drift_only_with(
      {{" - k.c2 * (p_", " - 0 * k.c2 * (p_"}},
      {.model = soft_chain(5), .request = {.alpha = "3/10", .beta = "1/7", .gamma = "-1/9"}});
}

TEST(Drift, AFixedPointIsRefinedBelowTheLastPlace) {
  expect_drift_only_with({{"refinement_0.change[", "0 * refinement_0.change["}},
                         {.model = soft_chain(3), .request = {.solver = "fixed-point"}, .h = 0.2});
}

// Where the rounded map comes to rest is no chance.
TEST(Drift, AFixedPointIsRefinedFromAfar) {
  expect_drift_only_with({{"moved <= units * epsilon * (length", "moved <= 0 * epsilon * (length"}},
                         {.model = soft_chain(4), .request = {.solver = "fixed-point"}, .h = 0.25});
}

// In float so far a difference is not linear.
TEST(Drift, AFixedPointInFloatIsRefinedFromNearerBy) {
  expect_drift_only_with({{"? 16384 : 4", "? 16384 : 64"}},
                         {.model = beating_ring(30, "1/5"),
                          .request = {.solver = "fixed-point"},
                          .conserved = Conserved::invariant,
                          .h = 0.3,
                          .scalar = "float"},
                         {.steps = 100'000});
}

// The small one of two products says how the large one is rounded beside it, in float too.
TEST(Drift, InFloatTheSmallerPartOfAConstantIsNotTooSmall) {
  expect_drift_only_with({{"= 0.9999f * ", "= 0.999999f * "}},
                         {.model = soft_chain(2, "0.9"), .request = {}, .h = 2, .scalar = "float"},
                         {.steps = 1'000'000});
}

// The rounds of a refinement have other equations than its beginning.
TEST(Drift, InFloatBothFormsOfStagesAreLookedAtAtOnePoint) {
  expect_drift_only_with(
      {{"Refinement<2, 4, false, true>", "Refinement<2, 4>"}},
      {.model = oscillator(), .request = {.scheme = "gauss-4"}, .h = 100, .scalar = "float"});
}

// Below: whose image its iterate is, rounding has chosen.
TEST(Drift, AFixedPointInLoopsIsRefinedFromItsIterate) {
  expect_drift_only_with(
      {{"settled || contraction * of_two(96) <= 1;", "settled || contraction * of_two(32) <= 1;"}},
      {.model = ring(30), .request = {.solver = "fixed-point"}, .h = 0.3},
      {.steps = 100'000, .starts = 16});
}

// With rounds that end by the contraction of lengths: with those that there are it takes longer
// to be seen.
TEST(Drift, ConstantsInForcesOfAFixedPointAreInTwoParts) {
  expect_drift_only_with(
      {{"return magnitude(error[j]) / (unit + tiny);", "return magnitude(error[j]);"},
       {"= 0.9999 * par.k;", "= par.k;"},
       {"= 0.9999 * par.b;", "= par.b;"},
       {"= 0.59994;", "= 0.6;"}},
      {.model = ring(30), .request = {.solver = "fixed-point"}, .h = 0.3},
      {.steps = 50'000, .starts = 12});
}

TEST(Drift, NothingIsLostOfTheSumsOfKicks) {
  expect_drift_only_with({{"lost += error;", ""}},
                         {.model = oscillator(), .request = {.scheme = "sbab-3"}, .h = 0.2});
}

// 3e-4 units a step: that takes a while to be seen.
TEST(Drift, ASplittingThatIsNoWayBackLooksAtAllOfASum) {
  expect_drift_only_with({{"now.p += lost_z_p;", ""}, {"now.q += lost_z_q;", ""}},
                         {.model = oscillator(), .request = {.scheme = "ruth-3"}, .h = 0.2},
                         {.steps = 1'000'000, .starts = 32});
}

TEST(Drift, NewtonWithAConstantMatrixDoesNotDrift) {
  const Result result = result_of({.model = chain(6), .request = {}});
  EXPECT_FALSE(result.drifts()) << words(result);
}

}  // namespace
}  // namespace hamgen::drift
