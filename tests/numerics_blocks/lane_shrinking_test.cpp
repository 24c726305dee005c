// How errors shrink, in each lane as of one trajectory alone.
#include <gtest/gtest.h>

#include <vector>

#include "tests/numerics_blocks/lane_rules.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

constexpr double kUnit = 0x1p-52;
const double kContractions[kCount] = {0x1p-9, 0x1p-4, -0.3, 0, 0x1p-10, -0x1p-9, 0.25, 0x1p-8};

// Of x = s + b (x - s), where s is a third of a unit from 1, and beside it y = b (x - s + y), which
// comes to nearly nothing.
template <class Number>
void lacks(const Number& b, const Number (&point)[2], const Number& small, Number (&lack)[2]) {
  const Number error = point[0] - 1 - kUnit / 3;
  const Number beside = point[1] - small;
  lack[0] = b * error - error;
  lack[1] = b * (error + beside) - beside;
}
double small_in(int step) { return step < 20 ? 1.0 : 0x1p-30; }
double start_of(int lane, int step) { return step % 3 == 0 ? 0.5 + lane * 0x1p-5 : 0.75; }
bool is_settled(int lane, int step) { return (lane + step) % 4 != 0; }
double units_of(int lane, int step) { return is_settled(lane, step) ? 16 : 4096; }
bool is_sure(int lane, int step) { return (lane + 3 * step) % 7 == 0; }

template <class Rule>
void prepare(Rule& rule) {
  rule.contraction = 0x1p-20;
  rule.round_off = kUnit;
}

// Steps in which lanes are settled or not, believed or doubted at different times; lane 4 has no
// part in every fifth.
TEST(LaneRefinement, EachLaneKnowsHowErrorsShrinkAsAlone) {
  lanes::ContractionRule<1> rule;
  lanes::Refinement<2, 2> together;
  std::vector<of_double::ContractionRule<1>> others(kCount);
  std::vector<of_double::Refinement<2, 2>> alone(kCount);
  lanes::Real b = 0;
  for (int lane = 0; lane < kCount; ++lane) b.set(lane, kContractions[lane]);
  int settled = 0;
  int refined = 0;
  for (int step = 0; step < 60; ++step) {
    const double small = small_in(step);
    const bool has_part = step % 5 != 0;
    lanes::Turn turn = turn_of_all();
    lanes::Real turns = 1, sure = 0, ends = 0, from = 0;
    if (!has_part) turns.set(4, 0);
    for (int lane = 0; lane < kCount; ++lane) {
      sure.set(lane, is_sure(lane, step) ? 1 : 0);
      ends.set(lane, is_settled(lane, step) ? 1 : 0);
      from.set(lane, start_of(lane, step));
    }
    turn.begin(turns > 0);
    prepare(rule);
    rule.settled = turns * ends > 0;
    rule.sure = sure > 0;
    lanes::Real x[2] = {1, small}, lack[2];
    for (int lane = 0; lane < kCount; ++lane) x[0].set(lane, 1 + units_of(lane, step) * kUnit);
    const lanes::Real start[2] = {from, from * small}, little = small, slope[2] = {0, 0};
    lacks(b, x, little, lack);
    together.foresee(rule, x, lack, start);
    for (int j = 0; j < 2; ++j) x[j] += lack[j];
    for (bool more = true; more;) {
      lacks(b, x, little, lack);
      more = together(turn, rule, x, lack, slope);
    }
    for (int lane = 0; lane < kCount; ++lane) {
      of_double::ContractionRule<1>& other = others[lane];
      of_double::Refinement<2, 2>& own = alone[lane];
      if (has_part || lane != 4) {
        prepare(other);
        other.settled = is_settled(lane, step);
        other.sure = is_sure(lane, step);
        double y[2] = {1 + units_of(lane, step) * kUnit, small}, lack_of_lane[2];
        const double begun[2] = {start_of(lane, step), start_of(lane, step) * small},
                     slopes[2] = {0, 0};
        lacks(kContractions[lane], y, small, lack_of_lane);
        own.foresee(other, y, lack_of_lane, begun);
        for (int j = 0; j < 2; ++j) y[j] += lack_of_lane[j];
        for (bool more = true; more;) {
          lacks(kContractions[lane], y, small, lack_of_lane);
          more = own(other, y, lack_of_lane, slopes);
        }
        EXPECT_EQ(rule.settled[lane], other.settled) << lane << " in step " << step;
        (other.settled ? settled : refined) += 1;
      }
      EXPECT_EQ(together.untold[lane], own.untold) << lane << " in step " << step;
      for (int j = 0; j < 2; ++j) {
        EXPECT_EQ(together.longest[j][lane], own.longest[j]) << lane << " in step " << step;
        EXPECT_EQ(together.spans[j][lane], own.spans[j]) << lane << " in step " << step;
        EXPECT_EQ(together.shrinks[j][lane], own.shrinks[j]) << lane << " in step " << step;
      }
    }
  }
  EXPECT_GT(settled, 80);
  EXPECT_GT(refined, 100);
  together.forget();
  for (int lane = 0; lane < kCount; ++lane) {
    EXPECT_EQ(together.untold[lane], 48);
    for (int j = 0; j < 2; ++j) EXPECT_EQ(together.shrinks[j][lane], 0);
  }
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
