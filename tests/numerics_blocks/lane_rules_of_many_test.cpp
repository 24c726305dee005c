// The rules of several unknowns in a batch: each lane knows of its own what it would know alone.
#include <gtest/gtest.h>

#include "tests/numerics_blocks/lane_rules.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

// Lanes 2 and 5 have come to the solution without it.
TEST(LaneRulesOfMany, ALaneThatDoesWithoutNewtonIsNotWatched) {
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

// What a lane knows of its unknowns is the same whichever of the others come to their solutions so.
TEST(LaneRulesOfMany, AWaitingLaneIsWatchedAsAlone) {
  lanes::WaitingNewtonRule<2, 2> among, alone;
  lanes::History<2> history;
  Numbers chance;
  for (int step = 0; step < 300; ++step) {
    const bool has_turn = chance.next() > 0;
    lanes::Real solution[2], moved[2];
    for (int j = 0; j < 2; ++j) {
      for (int lane = 0; lane < kCount; ++lane)
        solution[j].set(lane, std::ldexp(1 + chance.next() / 2, (j == 0 ? step : -step) / 10));
      moved[j] = solution[j] * 0x1p-30;
    }
    const auto take = [&](lanes::WaitingNewtonRule<2, 2>& rule, bool others) {
      lanes::Real turns = others ? 1 : 0;
      turns.set(3, has_turn ? 1 : 0);
      lanes::Turn turn;
      turn.begin(turns > 0);
      if (any(turn.lanes)) {
        rule.begin(step > 0, turn);
        rule.know(solution, moved, 2);
      }
      rule.watch(history, solution, 0, 2);
    };
    take(among, true);
    take(alone, false);
    history.record(solution);
    for (int j = 0; j < 2; ++j) {
      EXPECT_EQ(among.unit[j][3], alone.unit[j][3]) << step;
      EXPECT_EQ(among.moves[j][3], alone.moves[j][3]) << step;
      EXPECT_EQ(among.bends[j][3], alone.bends[j][3]) << step;
    }
    EXPECT_EQ(among.motion.move[3], alone.motion.move[3]) << step;
    EXPECT_EQ(alone.unit[0][0], 0.0);
  }
  EXPECT_LT(alone.unit[0][3], 0x1p-20);  // it has followed
}

// Increments of an unknown that is a 2^-20th of the other, in each lane by another contraction.
TEST(LaneRulesOfMany, SmallUnknownsOfAnApproximateMatrixAreWaitedForInEachLaneAsAlone) {
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
TEST(LaneRulesOfMany, SizesFollowTheUnknownsOfEachLaneAsAlone) {
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
TEST(LaneRulesOfMany, NoiseIsHeardInEachLaneAsAlone) {
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

}  // namespace
}  // namespace hamgen::numerics_blocks_test
