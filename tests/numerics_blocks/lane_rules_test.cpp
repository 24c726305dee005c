// The rules of a batch: an iteration ends in a lane where it would end for one trajectory alone.
#include "tests/numerics_blocks/lane_rules.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hamgen::numerics_blocks_test {
namespace {

template <int Power>
void expect_newton_ends_as_alone(double uneven) {
  for (const bool predicted : {false, true}) {
    for (const int batch : {0, 1}) {
      lanes::NewtonRuleOfMany<Power, 1> rule;
      rule.begin(predicted, turn_of_all());
      ask_together(batch, [&](const lanes::Real& size, int iteration) {
        return rule.of_sums(&size, &size, size, lanes::Real(uneven), size, lanes::Real(1), 1,
                            iteration);
      });
      for (int lane = 0; lane < kCount; ++lane) {
        of_double::NewtonRuleOfMany<Power, 1> alone;
        alone.begin(predicted);
        const Increments& increments = increments_of(batch, lane);
        const End end = end_alone(increments, [&](double size, int iteration) {
          return alone.of_sums(&size, &size, size, uneven, size, 1, 1, iteration);
        });
        EXPECT_EQ(end_in(rule, lane), end) << increments.name << " " << predicted << Power;
      }
    }
  }
}

TEST(LaneRules, NewtonsIterationEndsInEachLaneAsAlone) {
  expect_newton_ends_as_alone<1>(0);
  for (const double uneven : {0.0, 1e-6, 1.0, 1e6}) expect_newton_ends_as_alone<2>(uneven);
}

// Of rules that begin alike and are asked alike.
template <class Together, class Alone>
void expect_ends_as_alone(const Together& fresh, const Alone& fresh_alone) {
  for (const int batch : {0, 1}) {
    Together rule = fresh;
    ask_together(batch, [&](const lanes::Real& size, int iteration) {
      return rule(moved_by(size), iteration);
    });
    for (int lane = 0; lane < kCount; ++lane) {
      Alone alone = fresh_alone;
      const Increments& increments = increments_of(batch, lane);
      const End end = end_alone(
          increments, [&](double size, int iteration) { return alone(moved_by(size), iteration); });
      EXPECT_EQ(end_in(rule, lane), end) << increments.name;
    }
  }
}

TEST(LaneRules, AFixedPointEndsInEachLaneAsAlone) {
  lanes::FixedPointRule<2> rule;
  rule.begin(turn_of_all());
  of_double::FixedPointRule<2> alone;
  alone.begin();
  expect_ends_as_alone(rule, alone);
}

TEST(LaneRules, AnImpatientOneEndsInEachLaneAsAlone) {
  lanes::ImpatientRule rule;
  rule.begin(turn_of_all());
  of_double::ImpatientRule alone;
  alone.begin();
  expect_ends_as_alone(rule, alone);
}

// Step after step, each lane with a contraction of its own: some end with their first increment,
// which is told by the step before, and wait for the others.
TEST(LaneRules, AFixedPointIsToldInEachLaneByItsStepBefore) {
  lanes::FixedPointRule<2> rule;
  of_double::FixedPointRule<2> alone[kCount];
  lanes::Turn turn;
  int at_once = 0;
  for (int step = 1; step <= 31; ++step) {
    turn.begin(true);
    ASSERT_FALSE(turn.is_check());
    rule.begin(turn);
    const auto size_in = [&](int lane, int iteration) {
      const double first = 0x1p-52 * (40 + 40 * ((lane + step) % 8));
      return first * std::pow(0x1p-2, (1 + lane % 4) * (iteration - 1));
    };
    for (int iteration = 1, open = 1; open != 0; ++iteration) {
      lanes::Real size = 0;
      for (int lane = 0; lane < kCount; ++lane) size.set(lane, size_in(lane, iteration));
      open = any(rule(moved_by(size), iteration)) ? 1 : 0;
    }
    for (int lane = 0; lane < kCount; ++lane) {
      of_double::FixedPointRule<2>& one = alone[lane];
      one.begin();
      int taken = 0;
      Verdict verdict = Verdict::go_on;
      while (verdict == Verdict::go_on) {
        ++taken;
        verdict = one(moved_by(size_in(lane, taken)), taken);
      }
      EXPECT_EQ(rule.taken[lane], taken) << step << " " << lane;
      EXPECT_EQ(rule.contraction[lane], one.contraction) << step << " " << lane;
      at_once += taken == 1 && size_in(lane, 1) > 64 * 0x1p-52 ? 1 : 0;
    }
  }
  EXPECT_GT(at_once, 20);
  // The 32nd step measures it in all lanes.
  turn.begin(true);
  ASSERT_TRUE(turn.is_check());
  rule.begin(turn);
  (void)rule(moved_by(lanes::Real(100 * 0x1p-52)), 1);
  EXPECT_TRUE(all(rule.open));
}

template <int Cycle>
void expect_contraction_as_alone() {
  for (const int work : {0, 4}) {
    for (const double known : {0.0, 0x1p-14, 0x1p-9, 0.3}) {
      lanes::ContractionRule<Cycle> rule;
      of_double::ContractionRule<Cycle> alone;
      if (known > 0) rule.learn(true, known);
      if (known > 0) alone.learn(known);
      rule.begin(turn_of_all(), work);
      alone.begin(work);
      expect_ends_as_alone(rule, alone);
      for (const int batch : {0, 1}) {
        lanes::ContractionRule<Cycle> together = rule;
        ask_together(batch, [&](const lanes::Real& size, int iteration) {
          return together(moved_by(size), iteration);
        });
        for (int lane = 0; lane < kCount; ++lane) {
          of_double::ContractionRule<Cycle> other = alone;
          const Increments& increments = increments_of(batch, lane);
          end_alone(increments,
                    [&](double size, int iteration) { return other(moved_by(size), iteration); });
          EXPECT_EQ(together.settled[lane], other.settled) << increments.name << " " << known;
          EXPECT_EQ(together.moves()[lane], other.moves()) << increments.name << " " << known;
          EXPECT_EQ(together.contraction[lane], other.contraction) << increments.name;
        }
      }
    }
  }
}
TEST(LaneRules, AContractionEndsAndIsLearntInEachLaneAsAlone) {
  expect_contraction_as_alone<1>();
  expect_contraction_as_alone<2>();
}

// From what is known on, in a step that checks and in one that does not.
TEST(LaneRules, LinearEquationsAreSolvedInEachLaneAsAlone) {
  for (const int batch : {0, 1}) {
    for (const double known : {0.0, 0x1p-52, 1e-4}) {
      for (const bool checks : {false, true}) {
        lanes::Turn turn;
        for (int step = 0; step < (checks ? 32 : 1); ++step) turn.begin(true);
        ASSERT_EQ(turn.is_check(), checks);
        lanes::LinearRule rule;
        if (known > 0) rule.contraction = lanes::Real(known);
        rule.begin(turn);
        ask_together(batch, [&](const lanes::Real& size, int iteration) {
          return rule(size, lanes::Real(1), iteration, size * 3);
        });
        for (int lane = 0; lane < kCount; ++lane) {
          of_double::LinearRule alone;
          if (known > 0) alone.contraction = known;
          if (checks) alone.unchecked = 31;
          alone.begin();
          const Increments& increments = increments_of(batch, lane);
          const End end = end_alone(increments, [&](double size, int iteration) {
            return alone(size, 1, iteration, size * 3);
          });
          EXPECT_EQ(end_in(rule, lane), end) << increments.name << " " << known;
          EXPECT_EQ(rule.contraction[lane], alone.contraction) << increments.name << " " << known;
        }
      }
    }
  }
}

TEST(LaneRules, AllLanesCheckTheirContractionInTheSameStep) {
  lanes::Turn turn;
  int checks = 0;
  for (int step = 1; step <= 64; ++step) {
    turn.begin(true);
    EXPECT_EQ(turn.is_check(), step % 32 == 0) << step;
    lanes::ContractionRule<1> rule;
    rule.learn(true, 0x1p-14);
    rule.begin(turn, 0);
    rule(moved_by(lanes::Real(16 * 0x1p-52)), 1);
    EXPECT_EQ(all(rule.settled), !turn.is_check());
    if (turn.is_check()) ++checks;
  }
  EXPECT_EQ(checks, 2);
}

TEST(LaneRules, AMatrixServesInEachLaneAsAlone) {
  for (const double residual : {0.0, 1.0}) {
    for (const bool factorised : {false, true}) {
      for (const int batch : {0, 1}) {
        lanes::SimplifiedNewtonRule rule;
        lanes::Mask served = factorised;
        std::vector<lanes::Mask> together;
        rule.begin(turn_of_all(), served);
        ask_together(batch, [&](const lanes::Real& size, int iteration) {
          const lanes::Mask open = rule(moved_by(size), lanes::Real(residual), served, iteration);
          together.push_back(served);
          served = served | open;  // the next iteration has a matrix of its own
          return open;
        });
        for (int lane = 0; lane < kCount; ++lane) {
          of_double::SimplifiedNewtonRule alone;
          bool serves = factorised;
          std::vector<bool> flags;
          alone.begin(serves);
          const Increments& increments = increments_of(batch, lane);
          const End end = end_alone(increments, [&](double size, int iteration) {
            const Verdict verdict = alone(moved_by(size), residual, serves, iteration);
            flags.push_back(serves);
            if (verdict == Verdict::go_on) serves = true;
            return verdict;
          });
          EXPECT_EQ(end_in(rule, lane), end) << increments.name;
          // A lane that has ended keeps what it has, whatever its neighbours go on with.
          for (std::size_t i = 0; i < together.size(); ++i) {
            const bool flag = flags[std::min(i, flags.size() - 1)];
            EXPECT_EQ(together[i][lane], flag) << increments.name << " " << i;
          }
        }
      }
    }
  }
}

// The lanes without a part in it are neither waited for nor changed.
TEST(LaneRules, ALaneWithoutATurnIsNotWaitedFor) {
  lanes::Real one_nan = 1e-20;
  one_nan.set(2, std::numeric_limits<double>::quiet_NaN());
  for (const bool has_turn : {false, true}) {
    lanes::Turn turn;
    turn.begin((one_nan == one_nan) | lanes::Mask(has_turn));
    lanes::StepReport report;
    lanes::NewtonRule<2> rule;
    rule.begin(false, turn);
    EXPECT_FALSE(any(rule(one_nan, lanes::Real(1), 1)));
    EXPECT_EQ(rule.failed[2], has_turn);
    EXPECT_FALSE(rule.failed[1]);
    end_iteration(report, turn, rule);
    EXPECT_FALSE(turn.lanes[2]);
    EXPECT_TRUE(turn.lanes[1]);
    EXPECT_EQ(report.converged[2], !has_turn);
    EXPECT_EQ(report.iterations[2], has_turn ? 1 : 0);
    lanes::FixedPointRule<2> fixed;
    turn.begin((one_nan == one_nan) | lanes::Mask(has_turn));
    fixed.begin(turn);
    EXPECT_FALSE(any(fixed(moved_by(one_nan), 1)));
    EXPECT_EQ(fixed.failed[2], has_turn);
  }
}

TEST(LaneRules, WhatALaneForgetsTheOthersKnow) {
  lanes::NewtonRuleOfMany<2, 2> rule;
  rule.unit[1] = 3;
  rule.contraction = 0.5;
  rule.motion.move = 1;
  lanes::Real lane_2 = 0;
  lane_2.set(2, 1);
  rule.forget(lane_2 > 0);
  EXPECT_EQ(rule.contraction[2], lanes::largest);
  EXPECT_EQ(rule.motion.move[2], 0);
  EXPECT_EQ(rule.contraction[1], 0.5);
  EXPECT_EQ(rule.motion.move[1], 1);
  EXPECT_EQ(rule.unit[1][2], 0);
  EXPECT_EQ(rule.unit[1][1], 3);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
