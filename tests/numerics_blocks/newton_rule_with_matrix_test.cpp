// The rule that looks at the matrix of its equations: in every scalar, and in lanes as alone.
#include "tests/numerics_blocks/lane_rules.hpp"
#include "tests/numerics_blocks/rules_of_many.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Number>
struct Whole {
  Number entry[2][2] = {};
  const Number& at(int row, int column) const { return entry[row][column]; }
};

template <class Blocks>
class NewtonRuleWithMatrix : public RulesOfMany<Blocks> {};
TYPED_TEST_SUITE(NewtonRuleWithMatrix, EveryScalar);

// What an entry has turned by, times the way of the one unknown, bends the equation of the other:
// in this step or in the last one.
TYPED_TEST(NewtonRuleWithMatrix, EachBendsByWhatTheMatrixHasTurned) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template NewtonWithMatrix<2> rule;
  rule.unit[0] = 1;
  rule.unit[1] = 4;
  Whole<Real> matrix{{{1, Real(0.25)}, {Real(0.25), 2}}};
  rule.begin(true);
  rule.compare(matrix, 2);
  EXPECT_EQ(rule.bends[0], 0);
  rule.ways[0] = Real(0.5);
  rule.ways[1] = Real(0.125);
  rule.begin(true);
  rule.compare(matrix, 2);
  EXPECT_EQ(rule.bends[1], 0);
  EXPECT_EQ(rule.motion.bend, 0);
  EXPECT_EQ(rule.moves[1], Real(0.125));
  EXPECT_EQ(rule.motion.move, Real(0.5) + Real(4 * 0.125));
  EXPECT_EQ(rule.motion.least, Real(0.5));
  matrix.entry[0][0] += 2;
  matrix.entry[1][0] = matrix.entry[0][1] += 1;
  matrix.entry[1][1] += Real(0.5);
  rule.begin(true);
  rule.compare(matrix, 2);
  EXPECT_EQ(rule.bends[0], Real(2 * 0.5 + 1 * 0.125));
  EXPECT_EQ(rule.bends[1], Real(1 * 0.5 + 0.5 * 0.125));
  EXPECT_EQ(rule.motion.bend, rule.bends[0] + 4 * rule.bends[1]);
  // Later iterations are no other step.
  const Real moved[2] = {Real(0.25), Real(0.25)};
  const Real length[2] = {1, 1};
  EXPECT_EQ(rule.of_each(moved, length, length, 2, 1), TypeParam::Answer::go_on);
  const Real before = rule.bends[0];
  matrix.entry[0][0] += 5;
  rule.compare(matrix, 2);
  EXPECT_EQ(rule.bends[0], before);
  EXPECT_EQ(rule.slopes[0][0], 3);
  // What has turned back has been bent.
  matrix.entry[0][0] -= 5;
  rule.begin(true);
  rule.compare(matrix, 2);
  EXPECT_EQ(rule.bends[0], before);
  rule.begin(true);
  rule.compare(matrix, 2);
  EXPECT_EQ(rule.bends[0], 0);
}

// Of two that go together, and are held by a spring that has hardened, the distance counts.
TYPED_TEST(NewtonRuleWithMatrix, WhatMovesTogetherHasNotMoved) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template NewtonWithMatrix<2> rule;
  rule.unit[0] = rule.unit[1] = 1;
  Whole<Real> matrix{{{2, -1}, {-1, 2}}};
  rule.begin(true);
  rule.compare(matrix, 2);
  const Real apart = TypeParam::two_to(-10);
  rule.ways[0] = 1;
  rule.ways[1] = 1 + apart;
  const Real harder = TypeParam::two_to(-3);
  matrix = {{{2 + harder, -1 - harder}, {-1 - harder, 2 + harder}}};
  rule.begin(true);
  rule.compare(matrix, 2);
  EXPECT_EQ(rule.moves[0], harder * apart / (harder * (2 + apart)));
  EXPECT_EQ(rule.motion.least, rule.moves[0]);
  EXPECT_EQ(rule.bends[0], harder * (2 + apart));
  // An increment of a 2^-29th: it leaves bend (increment / move)^2, 2^-38 of their size.
  const Real moved[2] = {TypeParam::two_to(-29), TypeParam::two_to(-29)};
  const Real length[2] = {1, 1};
  EXPECT_EQ(rule.is_in_reach(moved, length, length, 2), TypeParam::bits == 24);
}

// A fast linear oscillation leaves nothing: one increment is enough, as often as its force is the
// same, where differences of its solutions ask for another one.
TYPED_TEST(NewtonRuleWithMatrix, AnOscillationIsStraightAsLongAsItsMatrixStands) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const auto after = [&](auto rule, Real turns) {
    for (Real& unit : rule.unit) unit = 1;
    rule.contraction = TypeParam::unit;
    rule.unchecked = 0;
    typename TypeParam::template Past<2> past;
    Whole<Real> matrix{{{1, 0}, {0, 1}}};
    rule.fresh = 0;
    // Half a radian a step: x, y turn by 3/5, 4/5 on a circle of a 16th.
    Real x = Real(1) / 16, y = 0;
    for (int k = 0; k < 6; ++k) {
      const Real turned = (4 * x - 3 * y) / 5;
      y = (3 * x + 4 * y) / 5;
      x = turned;
      const Real solution[2] = {1 + x, 1 + y};
      rule.begin(k > 0);
      if constexpr (requires { rule.slopes; }) rule.compare(matrix, 2);
      rule.watch(past, solution, 0, 2);
      past.record(solution);
    }
    matrix.entry[0][0] += turns;
    rule.begin(true);
    if constexpr (requires { rule.slopes; }) rule.compare(matrix, 2);
    const Real small = TypeParam::two_to(-(TypeParam::bits + 11) / 2);
    const Real moved[2] = {small, small};
    const Real length[2] = {1, 1};
    return rule.of_each(moved, length, length, 2, 1);
  };
  EXPECT_EQ(after(typename TypeParam::template NewtonOfMany<2, 2>(), 0), Verdict::go_on);
  EXPECT_EQ(after(typename TypeParam::template NewtonWithMatrix<2>(), 0), Verdict::done);
  EXPECT_EQ(after(typename TypeParam::template NewtonWithMatrix<2>(), 4), Verdict::go_on);
}

// In lanes that are in their turn one half after the other, each as its own rule does.
TEST(LaneRuleWithMatrix, EachLaneComparesAsAlone) {
  lanes::NewtonRuleWithMatrix<2> rule;
  of_double::NewtonRuleWithMatrix<2> alone[kCount];
  lanes::History<2> history;
  of_double::History<2> histories[kCount];
  for (lanes::Real& unit : rule.unit) unit = 1;
  for (auto& one : alone) one.unit[0] = one.unit[1] = 1;
  int turned = 0;
  for (int step = 0; step < 40; ++step) {
    Whole<lanes::Real> matrix;
    lanes::Real solution[2];
    for (int lane = 0; lane < kCount; ++lane) {
      const double beside = 0.3 * lane + 0.001 * step * step;
      Whole<double> own{
          {{1 + 0.01 * lane * (step % 3), beside}, {beside, 2 - 0.003 * step * step}}};
      for (int r = 0; r < 2; ++r)
        for (int c = 0; c < 2; ++c) matrix.entry[r][c].set(lane, own.entry[r][c]);
      const double values[2] = {1 + 0.1 * lane + 0.02 * step, 2 - 0.01 * step * lane};
      for (int j = 0; j < 2; ++j) solution[j].set(lane, values[j]);
      of_double::NewtonRuleWithMatrix<2>& one = alone[lane];
      one.begin(true);
      one.compare(own, 2);
      one.watch(histories[lane], values, 0, 2);
      histories[lane].record(values);
    }
    lanes::Real half = 0;
    for (int lane = 0; lane < kCount; lane += 1 + step % 3) half.set(lane, 1);
    for (const lanes::Mask in_turn : {half > 0, !(half > 0)}) {
      lanes::Turn turn;
      turn.begin(in_turn);
      rule.begin(true, turn);
      rule.compare(matrix, 2);
    }
    for (int lane = 0; lane < kCount; ++lane) {
      for (int j = 0; j < 2; ++j) {
        EXPECT_EQ(rule.bends[j][lane], alone[lane].bends[j]) << step << " " << lane;
        if (rule.bends[j][lane] > 0) ++turned;
      }
    }
    rule.watch(history, solution, 0, 2);
    history.record(solution);
    for (int lane = 0; lane < kCount; ++lane) {
      EXPECT_EQ(rule.moves[0][lane], alone[lane].moves[0]) << step << " " << lane;
      EXPECT_EQ(rule.fresh[lane], step < 4 ? 3 - step : 0);
      EXPECT_EQ(alone[lane].fresh, step < 4 ? 3 - step : 0);
    }
  }
  EXPECT_GT(turned, 100);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
