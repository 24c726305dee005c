// The rules of a batch: an iteration ends in a lane where it would end for one trajectory alone.
#include "tests/numerics_blocks/lane_rules.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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

TEST(LaneRules, AContractionEndsAndIsLearntInEachLaneAsAlone) {
  for (const int work : {0, 4}) {
    for (const double known : {0.0, 0x1p-14, 0x1p-9, 0.3}) {
      lanes::ContractionRule rule;
      of_double::ContractionRule alone;
      if (known > 0) rule.learn(true, known);
      if (known > 0) alone.learn(known);
      rule.begin(turn_of_all(), work);
      alone.begin(work);
      expect_ends_as_alone(rule, alone);
      for (const int batch : {0, 1}) {
        lanes::ContractionRule together = rule;
        ask_together(batch, [&](const lanes::Real& size, int iteration) {
          return together(moved_by(size), iteration);
        });
        for (int lane = 0; lane < kCount; ++lane) {
          of_double::ContractionRule other = alone;
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
    lanes::ContractionRule rule;
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

// Lanes 2 and 5 have come to the solution without it.
TEST(LaneRules, ALaneThatDoesWithoutNewtonIsNotWatched) {
  lanes::History<1> history;
  history.record({lanes::Real(1)});
  lanes::Real used = 1;
  for (const int lane : {2, 5}) used.set(lane, 0);
  lanes::Turn turn;
  turn.begin(used > 0);
  lanes::WaitingNewtonRule<2, 1> rule;
  rule.unit[0] = 0.5;
  rule.begin(false, turn);
  const lanes::Real solution[1] = {3};
  rule.watch(history, solution, 0, 1);
  for (int lane = 0; lane < kCount; ++lane) EXPECT_EQ(rule.motion.move[lane], used[lane]) << lane;
  rule.watch(history, solution, 0, 1);
  EXPECT_EQ(rule.motion.move[0], 0);
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

// Increments of an unknown that is a 2^-20th of the other, in each lane by another contraction.
TEST(LaneRules, SmallUnknownsOfAnApproximateMatrixAreWaitedForInEachLaneAsAlone) {
  const double contractions[] = {0, 0.1, 0.5, 0.95, 0.01, 0.3, 0.8, 0};
  constexpr double kSmall = 0x1p-20;
  lanes::Turn turn;
  turn.begin(true);
  turn.step = 1;  // not one that is a check
  lanes::NewtonRuleOfMany<1, 2> rule;
  rule.contraction = 0x1p-13;
  rule.begin(true, turn);
  lanes::Real moved[2] = {0x1p-54, 0};
  const lanes::Real length[2] = {1, kSmall};
  lanes::Real contraction = 0;
  for (int lane = 0; lane < 8; ++lane) {
    moved[1].set(lane, (1 + 200 * lane) * kSmall * 0x1p-52);
    contraction.set(lane, contractions[lane]);
  }
  for (int iteration = 1; iteration <= 60; ++iteration) {
    if (!any(rule.of_each(moved, length, length, 2, iteration))) break;
    moved[1] = moved[1] * contraction;
  }
  int waited = 0;
  for (int lane = 0; lane < 8; ++lane) {
    of_double::NewtonRuleOfMany<1, 2> alone;
    alone.contraction = 0x1p-13;
    alone.begin(true);
    double way[2] = {0x1p-54, (1 + 200 * lane) * kSmall * 0x1p-52};
    const double lengths[2] = {1, kSmall};
    int iteration = 1;
    while (alone.of_each(way, lengths, lengths, 2, iteration) == of_double::Verdict::go_on) {
      way[1] = way[1] * contractions[lane];
      ++iteration;
    }
    EXPECT_EQ(rule.taken[lane], iteration) << lane;
    waited += iteration > 2 ? 1 : 0;
  }
  EXPECT_GE(waited, 3);
}

// Each lane has units of its own, which follow its unknowns, and measures where one has changed.
TEST(LaneRules, SizesFollowTheUnknownsOfEachLaneAsAlone) {
  lanes::NewtonRuleOfMany<2, 3> rule;
  lanes::History<3> history;
  of_double::NewtonRuleOfMany<2, 3> alone[kCount];
  of_double::History<3> histories[kCount];
  Numbers chance;
  int measured = 0;
  for (int step = 0; step < 1000; ++step) {
    lanes::Real length[3], moved[3], solution[3];
    lanes::Turn turn;
    turn.begin(true);
    turn.step = 1;  // not one that is a check
    rule.begin(step > 0, turn);
    for (int j = 0; j < 3; ++j) {
      for (int lane = 0; lane < kCount; ++lane) {
        const double size = std::ldexp(1 + chance.next() / 2, -step * lane * j / 100);
        solution[j].set(lane, chance.next() > 0.9 ? size * 8 : size);
        length[j].set(lane, 2 * solution[j][lane]);
        moved[j].set(lane, std::abs(size * chance.next()) * 0x1p-45);
      }
    }
    const lanes::Mask open = rule.of_each(moved, length, length, 3, 1);
    for (int lane = 0; lane < kCount; ++lane) {
      of_double::NewtonRuleOfMany<2, 3>& one = alone[lane];
      one.contraction = rule.contraction[lane];
      // A lane's history knows more of what has no order.
      one.motion = {rule.motion.move[lane], rule.motion.bend[lane]};
      const bool forced = one.unchecked >= 32;
      if (!forced) one.unchecked = 0;
      measured += forced ? 1 : 0;
      one.begin(step > 0);
      double lengths[3], ways[3], values[3];
      for (int j = 0; j < 3; ++j) {
        lengths[j] = length[j][lane];
        ways[j] = moved[j][lane];
        values[j] = solution[j][lane];
      }
      const auto verdict = one.of_each(ways, lengths, lengths, 3, 1);
      EXPECT_EQ(open[lane], verdict == of_double::Verdict::go_on) << step << " " << lane;
      for (int j = 0; j < 3; ++j) EXPECT_EQ(rule.unit[j][lane], one.unit[j]) << step << " " << j;
      if (verdict == of_double::Verdict::go_on) one.unchecked = 0;
      one.watch(histories[lane], values, 0, 3);
      histories[lane].record(values);
    }
    if (any(open)) {
      for (lanes::Real& each : moved) each = each * 0x1p-20;
      (void)rule.of_each(moved, length, length, 3, 2);
    }
    rule.contraction = 0x1p-10;
    rule.watch(history, solution, 0, 3);
    history.record(solution);
  }
  EXPECT_GT(measured, 50);
}

// In lanes 3 and 6 one unknown is noise that stays as it is: it is heard there, and not again in
// the next step.
TEST(LaneRules, NoiseIsHeardInEachLaneAsAlone) {
  lanes::NewtonRuleOfMany<2, 2> rule;
  of_double::NewtonRuleOfMany<2, 2> alone[kCount];
  // Twice as loud later, where one increment is enough.
  const auto noise_of = [](int lane, int step) {
    return lane == 3 || lane == 6 ? (step == 0 ? 0x1p-54 : 0x1p-53) : 0.0;
  };
  const auto begin_with = [](auto& one) {
    one.unit[0] = 1;
    one.unit[1] = 0x1p40;
  };
  begin_with(rule);
  for (auto& one : alone) begin_with(one);
  for (int step = 0; step < 3; ++step) {
    const double first = step == 0 ? 0x1p-10 : 0;
    lanes::Turn turn;
    turn.begin(true);
    turn.step = 1;  // not one that is a check
    rule.begin(false, turn);
    rule.contraction = step == 0 ? 1 : 0x1p-10;
    rule.motion.move = 1;
    const lanes::Real length[2] = {1, 0x1p-40};
    bool open = true;
    for (int iteration = 1; open && iteration <= 60; ++iteration) {
      lanes::Real moved[2] = {std::pow(first, iteration), 0};
      for (int lane = 0; lane < kCount; ++lane) moved[1].set(lane, noise_of(lane, step));
      open = any(rule.of_each(moved, length, length, 2, iteration));
    }
    for (int lane = 0; lane < kCount; ++lane) {
      of_double::NewtonRuleOfMany<2, 2>& one = alone[lane];
      one.begin(false);
      one.contraction = step == 0 ? 1 : 0x1p-10;
      one.motion.move = one.motion.least = 1;
      const double lengths[2] = {1, 0x1p-40};
      auto verdict = of_double::Verdict::go_on;
      int taken = 0;
      while (verdict == of_double::Verdict::go_on) {
        ++taken;
        const double moved[2] = {std::pow(first, taken), noise_of(lane, step)};
        verdict = one.of_each(moved, lengths, lengths, 2, taken);
      }
      EXPECT_EQ(taken == 1, step > 0);
      EXPECT_EQ(rule.taken[lane], taken) << step << " " << lane;
      EXPECT_EQ(rule.unit[1][lane], one.unit[1]) << step << " " << lane;
      const bool is_heard = one.unit[1] < 0x1p40;
      EXPECT_EQ(is_heard, lane == 3 || lane == 6) << step << " " << lane;
    }
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
