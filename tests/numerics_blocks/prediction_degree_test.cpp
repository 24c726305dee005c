// How good a prediction of Newton's iteration has to be: no better than that one increment is left.
#include <cmath>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

using of_double::Blocks;

// A history that is told of nothing keeps the degree that predicts best.
template <int Unknowns>
struct BestOfAll : Blocks::Past<Unknowns> {
  [[nodiscard]] bool chooses() const { return false; }
};

struct UnitMatrix {
  [[nodiscard]] double at(int row, int column) const { return row == column ? 1 : 0; }
};

// Steps of an iteration whose increments shrink as next = contraction size^2, to solutions that
// turn by an angle a step.
template <class Rule, template <int> class Past, int Unknowns>
struct Steps {
  Rule rule;
  Past<Unknowns> past;
  double contraction = 1e-6;
  double angle = 0.05;
  long iterations = 0;
  long degrees = 0;  // that were kept in all steps

  void iterate(double size) {
    for (int iteration = 1; true; ++iteration) {
      ++iterations;
      if (answer(size, iteration) != Blocks::Answer::go_on) break;
      size = contraction * size * size;
    }
  }
  auto answer(double size, int iteration) {
    if constexpr (Unknowns == 1) {
      return rule(size, 2, iteration);
    } else {
      const double moved[2] = {size, size};
      const double length[2] = {2, 2};
      return rule.of_each(moved, length, length, 2, iteration);
    }
  }
  // Those up to the last have been taken; what counts is from here on.
  void take(int last, int watched = Unknowns) {
    iterations = degrees = 0;
    for (; taken_ < last; ++taken_) {
      phase_ += angle;
      double solution[Unknowns];
      for (int j = 0; j < Unknowns; ++j) solution[j] = std::cos(phase_ + j);
      double predicted[Unknowns] = {};
      if (past.known > 0) past.extrapolate(predicted);
      rule.begin(past.known > 0);
      if constexpr (requires { rule.turned; }) rule.compare(UnitMatrix(), Unknowns);
      iterate(std::fabs(solution[0] - predicted[0]));
      rule.watch(past, solution, 0, watched);
      past.record(solution);
      degrees += past.known;
    }
  }

 private:
  int taken_ = 0;
  double phase_ = 0;
};
template <template <int> class Past>
using OfOne = Steps<Blocks::Newton<2>, Past, 1>;
template <template <int> class Past>
using OfTwo = Steps<Blocks::NewtonOfMany<2, 2>, Past, 2>;
template <template <int> class Past>
using OfMatrix = Steps<Blocks::NewtonWithMatrix<2>, Past, 2>;

template <template <template <int> class> class Case>
void expect_as_few_iterations(double contraction, double angle, double degrees) {
  Case<Blocks::Past> steps;
  Case<BestOfAll> best;
  steps.contraction = best.contraction = contraction;
  steps.angle = best.angle = angle;
  for (const int last : {1000, 21000}) {
    steps.take(last);
    best.take(last);
  }
  EXPECT_LT(steps.iterations, 1.04 * best.iterations) << contraction << " " << angle;
  EXPECT_LT(steps.degrees, degrees * best.degrees) << contraction << " " << angle;
}

// Where one increment is enough (else in every 32nd step alone), whether it is the contraction that
// asks for more or the motion's bend.
TEST(PredictionDegree, IsNoHigherThanOneIncrementAsksFor) {
  for (const double contraction : {1e-12, 1e-6}) {
    for (const double angle : {0.02, 0.05, 0.07, 0.1}) {
      expect_as_few_iterations<OfOne>(contraction, angle, 0.9);
      expect_as_few_iterations<OfTwo>(contraction, angle, 0.9);
      expect_as_few_iterations<OfMatrix>(contraction, angle, 0.9);
    }
  }
}

// And where it seldom is, no iteration more is taken.
TEST(PredictionDegree, IsTheBestWhereOneIncrementIsNotEnough) {
  for (const double angle : {0.05, 0.07, 0.1}) {
    expect_as_few_iterations<OfOne>(100, angle, 1.01);
    expect_as_few_iterations<OfTwo>(100, angle, 1.01);
    expect_as_few_iterations<OfMatrix>(100, angle, 1.01);
  }
}

// What bends more asks for a higher degree than it had, and gets it.
TEST(PredictionDegree, RisesWhereTheMotionBendsMore) {
  OfTwo<Blocks::Past> steps;
  steps.take(1000);
  const int calm = steps.past.best;
  steps.angle = 0.1;
  steps.take(1100);
  steps.take(5100);
  EXPECT_GT(steps.past.best, calm);
  EXPECT_LT(steps.iterations, 4000 * 1.1);
}

// Where a part of the solution is another's, who says nothing, it stays the best of all.
TEST(PredictionDegree, IsTheBestWhereNotAllIsAskedFor) {
  OfTwo<Blocks::Past> steps;
  OfTwo<Blocks::Past> part;
  steps.take(1000);
  part.take(1000, 1);
  EXPECT_GE(part.past.best, 9);
  EXPECT_LT(steps.past.best, 9);
}

// Of what several ask for the highest is taken, a degree lower each time.
TEST(PredictionDegree, IsTheHighestThatAnyAsksFor) {
  Blocks::Past<3> past;
  const auto record = [&](int first, int last, const auto& ask) {
    for (int k = first; k < last; ++k) {
      if (past.chooses()) ask();
      const double solution[3] = {std::cos(0.05 * k), std::sin(0.05 * k), 1};
      past.record(solution);
    }
  };
  record(0, 400, [] {});
  const int best = past.best;
  EXPECT_GE(best, 9);
  record(400, 480, [&] {
    past.is_enough(past.degree() - 1, 1);
    past.is_enough(past.degree(), 1);
    past.is_enough(past.degree() - 1, 1);
  });
  EXPECT_EQ(past.best, best);
  record(480, 528, [&] { past.is_enough(past.degree() - 1, 3); });
  EXPECT_EQ(past.best, best - 3);
  record(528, 1000, [&] { past.is_enough(0, 3); });
  EXPECT_EQ(past.best, 0);
  EXPECT_EQ(past.known, 4);  // what rules look at
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
