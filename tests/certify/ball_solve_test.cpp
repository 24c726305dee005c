// Krawczyk's test: what it proves, and what it must not.
#include "app/studies/ball_solve.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hamgen::certify_test {
namespace {

using app::Ball;
using app::BallEquations;
using app::BallMatrix;
using app::BallSolution;
using app::BallVector;
using app::solve_in_balls;

constexpr long kBits = 128;

// x^2 = c
BallEquations square(double c) {
  return {[c](std::span<const Ball> x) { return BallVector{x[0] * x[0] - Ball(c, kBits)}; },
          [](std::span<const Ball> x) {
            return BallMatrix{{{0, 0}, Ball(2) * x[0]}};
          }};
}

TEST(SolveInBalls, EnclosesTheSolutionAndNoOther) {
  const BallSolution solution = solve_in_balls(square(2.0), {Ball(1.5, kBits)}, false, 16.0);
  ASSERT_EQ(solution.failure, "");
  const Ball& x = solution.x[0];
  EXPECT_TRUE((x * x - Ball(2)).contains_zero());
  // The midpoint errs by 2^-110 or so.
  EXPECT_LT((x - x.midpoint()).bound().upper(), 1e-30);
  // -sqrt(2) is 2 sizes away: a box of radius 2 would hold both.
  EXPECT_LT(solution.radius, 2.0);
  EXPECT_GT(solution.radius, 0.1);
}

TEST(SolveInBalls, ProvesNothingOfADoubleZeroOrNone) {
  EXPECT_NE(solve_in_balls(square(0.0), {Ball(1.0, kBits)}, false, 0.5).failure, "");
  EXPECT_NE(solve_in_balls(square(-1.0), {Ball(1.0, kBits)}, false, 0.5).failure, "");
}

// Newton from 0.01 jumps far beyond the zero at 1 and comes back to it, but in no box around 1 that
// reaches 0.01 and does without the other zero, -1, is there a proof.
TEST(SolveInBalls, ReachesTheNumbersItBeganWithWhereItMust) {
  EXPECT_EQ(solve_in_balls(square(1.0), {Ball(0.01, kBits)}, false, 0.5).failure, "");
  EXPECT_NE(solve_in_balls(square(1.0), {Ball(0.01, kBits)}, true, 0.5).failure, "");
  EXPECT_EQ(solve_in_balls(square(1.0), {Ball(0.99, kBits)}, true, 0.5).failure, "");
}

TEST(SolveInBalls, SaysWhereTheEquationsEnd) {
  const BallEquations logarithm{[](std::span<const Ball> x) {
                                  return BallVector{Ball::function("log", x.first(1)) + Ball(1)};
                                },
                                [](std::span<const Ball> x) {
                                  return BallMatrix{{{0, 0}, Ball(1) / x[0]}};
                                }};
  EXPECT_NE(solve_in_balls(logarithm, {Ball(-1.0, kBits)}, false, 0.5).failure, "");
  const BallSolution solution = solve_in_balls(logarithm, {Ball(0.5, kBits)}, false, 16.0);
  ASSERT_EQ(solution.failure, "");
  EXPECT_NEAR(solution.x[0].nearest(), std::exp(-1.0), 1e-15);
}

// With data in a ball the solution is enclosed for all of them.
TEST(SolveInBalls, HoldsForAllNumbersOfItsData) {
  const Ball data = Ball(2.0, kBits).widened(Ball(1e-10, kBits));
  const BallEquations equations{
      [&](std::span<const Ball> x) { return BallVector{x[0] * x[0] - data}; },
      [](std::span<const Ball> x) {
        return BallMatrix{{{0, 0}, Ball(2) * x[0]}};
      }};
  const BallSolution solution = solve_in_balls(equations, {Ball(1.4, kBits)}, false, 0.1);
  ASSERT_EQ(solution.failure, "");
  for (const double c : {2.0 - 1e-10, 2.0, 2.0 + 1e-10}) {
    const Ball root = Ball::function("sqrt", std::vector{Ball(c, kBits)});
    EXPECT_TRUE((solution.x[0] - root).contains_zero());
  }
}

}  // namespace
}  // namespace hamgen::certify_test
