// The blocks of a batch: what is decided in a lane is decided as for one trajectory alone.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {

namespace packs {
#include "tests/numerics_blocks/packs.inc"
}  // namespace packs

namespace {

constexpr int kLanes = 8;
constexpr int kRows = 5;

// Every lane has pivots of its own; that of lane 3 is singular, and lane 5 has a NaN.
TEST(LaneBlocks, AMatrixIsSolvedInEachLaneBitForBitAsAlone) {
  Numbers numbers;
  packs::DenseMatrix<kRows> together;
  of_double::DenseMatrix<kRows> alone[kLanes];
  packs::Real sides[kRows] = {};
  double side[kLanes][kRows] = {};
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kRows; ++c) {
      packs::Real entry = 0;
      for (int lane = 0; lane < kLanes; ++lane) {
        double value = numbers.next() / 3;
        if (lane == 3 && r == 2) value = 0;
        if (lane == 5 && r == 1 && c == 4) value = std::numeric_limits<double>::quiet_NaN();
        entry.set(lane, value);
        alone[lane].put(r, c, value);
      }
      together.put(r, c, entry);
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      side[lane][r] = numbers.next();
      sides[r].set(lane, side[lane][r]);
    }
  }
  const packs::Mask regular = together.factorise();
  together.solve(sides);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(regular[lane], lane != 3 && lane != 5) << lane;
    ASSERT_EQ(alone[lane].factorise(), regular[lane]) << lane;
    if (!regular[lane]) continue;
    alone[lane].solve(side[lane]);
    for (int r = 0; r < kRows; ++r) EXPECT_EQ(sides[r][lane], side[lane][r]) << lane;
  }
}

// Increments of an iteration from its first on, the last one again and again.
struct Increments {
  std::string name;
  std::vector<double> sizes;
  [[nodiscard]] double at(int iteration) const {
    const auto i = static_cast<std::size_t>(iteration - 1);
    return i < sizes.size() ? sizes[i] : sizes.back();
  }
};

// How many iterations, and whether the end was a success.
struct End {
  int iterations = 0;
  bool done = false;
  bool operator==(const End&) const = default;
};

End end_alone(const Increments& increments, bool predicted) {
  of_double::NewtonRule<2> rule;
  rule.begin(predicted);
  for (int iteration = 1;; ++iteration) {
    const of_double::Verdict verdict = rule(increments.at(iteration), 1, iteration);
    if (verdict != of_double::Verdict::go_on) {
      return {iteration, verdict == of_double::Verdict::done};
    }
  }
}

TEST(LaneBlocks, NewtonsIterationEndsInEachLaneAsAlone) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Increments> lanes = {{"quadratic", {1e-2, 1e-4, 1e-8, 1e-16}},
                                         {"at once", {1e-17}},
                                         {"lost", {1e-3, nan}},
                                         {"never", {1, 0.99}},
                                         {"astray", {1e-3, 9e-4, 1e-9, 0}},
                                         {"stands still", {1e-3, 1e-13, 2e-13, 3e-13}},
                                         {"infinite", {1e300, infinity}},
                                         {"fast", {1e-5, 1e-12}}};
  for (const bool predicted : {false, true}) {
    packs::NewtonRule<2> rule;
    rule.begin(predicted);
    for (int iteration = 1;; ++iteration) {
      packs::Real size = 0;
      for (int lane = 0; lane < kLanes; ++lane) {
        size.set(lane, lanes[static_cast<std::size_t>(lane)].at(iteration));
      }
      if (!any(rule(size, packs::Real(1), iteration))) break;
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      const Increments& increments = lanes[static_cast<std::size_t>(lane)];
      const End end = {static_cast<int>(rule.taken[lane]), !rule.failed[lane]};
      EXPECT_EQ(end, end_alone(increments, predicted)) << increments.name << " " << predicted;
    }
  }
}

TEST(LaneBlocks, ALaneThatIsStoppedIsNotWaitedFor) {
  packs::NewtonRule<2> rule;
  rule.stopped = packs::Real(1) <= 0;
  packs::Real one_nan = 1e-20;
  one_nan.set(2, std::numeric_limits<double>::quiet_NaN());
  rule.stopped = !(one_nan == one_nan);
  EXPECT_TRUE(rule.stopped[2]);
  rule.begin(false);
  EXPECT_FALSE(any(rule(one_nan, packs::Real(1), 1)));
  EXPECT_FALSE(any(rule.failed));
  rule.stopped = false;
  rule.begin(false);
  EXPECT_FALSE(any(rule(one_nan, packs::Real(1), 1)));
  EXPECT_TRUE(rule.failed[2]);
  EXPECT_FALSE(rule.failed[1]);
}

// Cubics are met as soon as four points are known, whatever polynomial or noise is beside them.
TEST(LaneBlocks, PolynomialsArePredictedInTheirLanes) {
  packs::History<1> history;
  Numbers numbers;
  packs::Real predicted[1] = {};
  for (int step = 0; step < 60; ++step) {
    packs::Real point = 0;
    const double x = step;
    for (int lane = 0; lane < kLanes; ++lane) {
      point.set(lane, lane % 2 == 0 ? lane + x - x * x * x / 64 : numbers.next());
    }
    if (step >= 8) {
      for (int lane = 0; lane < kLanes; lane += 2) {
        EXPECT_EQ(predicted[0][lane], point[lane]) << lane << " " << step;
      }
    }
    history.record({point});
    history.extrapolate(predicted);
  }
  EXPECT_GE(history.best[0], 3);
  EXPECT_LE(history.best[1], 4);
  forget(history);
  EXPECT_EQ(history.known, 0);
}

// Whatever degrees the others need.
TEST(LaneBlocks, APredictionDoesNotDependOnTheOtherLanes) {
  packs::History<2> mixed;
  packs::History<2> equal;
  Numbers numbers;
  for (int step = 0; step < 200; ++step) {
    packs::Real point = 0;
    const double x = 0.1 * step;
    for (int lane = 0; lane < kLanes; ++lane) {
      const double smooth = std::sin(x * (lane + 1));
      point.set(lane, lane % 2 == 0 ? smooth : numbers.next());
    }
    const packs::Real same = point[0];
    mixed.record({point, -point});
    equal.record({same, -same});
    packs::Real predicted[2] = {};
    packs::Real alone[2] = {};
    mixed.extrapolate(predicted);
    equal.extrapolate(alone);
    EXPECT_EQ(predicted[0][0], alone[0][0]) << step;
    EXPECT_EQ(predicted[1][0], alone[1][0]) << step;
    if (step > 20) EXPECT_GT(mixed.highest, mixed.best[1]) << step;
  }
}

// k^4 has the first difference 4 k^3 - ... and the fourth 24.
TEST(LaneBlocks, ErrorsAreDifferences) {
  packs::History<2> history;
  const auto power = [](int k) { return double(k) * k * k * k; };
  for (int k = 0; k < 10; ++k) {
    const packs::Real solution[2] = {packs::Real(power(k)), packs::Real(1)};
    const packs::Real first = history.error<0>(solution, 0, 2);
    const packs::Real fourth = history.error<3>(solution, 0, 1);
    EXPECT_EQ(first[0], k == 0 ? 0 : power(k) - power(k - 1)) << k;
    if (k >= 4) EXPECT_EQ(fourth[1], 24) << k;
    if (k == 3) EXPECT_EQ(fourth[1], 81 - 3 * 16 + 3) << k;
    EXPECT_EQ((history.error<0>(solution, 1, 1)[0]), 0) << k;
    history.record(solution);
  }
}

TEST(LaneBlocks, WhatAProductLosesIsExact) {
  Numbers numbers;
  packs::Real x = 0;
  packs::Real y = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    x.set(lane, numbers.next() / 3);
    y.set(lane, std::exp(numbers.next()));
  }
  const packs::Real error = packs::product_error(x, y);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(error[lane], std::fma(x[lane], y[lane], -(x[lane] * y[lane])));
    EXPECT_EQ(error[lane], of_double::product_error(x[lane], y[lane]));
  }
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
