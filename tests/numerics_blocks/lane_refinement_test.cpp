// The end of a fixed point of a batch: in each lane as of one trajectory alone.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <type_traits>
#include <vector>

#include "tests/numerics_blocks/lane_rules.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

// Of x = a + b f(x) from near its solution, with a contraction b that differs from lane to lane:
// what refinement finds, and how often it looks.
template <class Number, class Refine, class Map>
int refined(const Refine& refine, const Map& map, Number (&x)[2]) {
  int looks = 0;
  for (bool more = true; more; ++looks) {
    const Number next[2] = {map(x[1], 0), map(x[0], 1)};
    const Number lack[2] = {next[0] - x[0], next[1] - x[1]};
    const Number slope[2] = {next[0] * x[1], next[1] * next[1]};
    more = refine(x, lack, slope);
  }
  return looks;
}

TEST(LaneRefinement, WhatRoundingLacksIsFoundInEachLaneAsAlone) {
  const double contractions[kCount] = {0x1p-20, -0x1p-22, 0, 0.5, 0x1p-4, -0.3, 0x1p-40, -0.5};
  lanes::Real contraction = 0;
  for (int lane = 0; lane < kCount; ++lane) contraction.set(lane, contractions[lane]);
  for (const bool ruled : {false, true}) {
    lanes::Refinement<2, 2> together;
    lanes::ContractionRule<1> rule;
    lanes::Real x[2] = {};
    lanes::Turn turn = turn_of_all();
    const auto points = [&](int lane, double(&point)[2]) {
      const double b = contractions[lane];
      for (int i = 0; i < 400; ++i) {
        const double old = point[0];
        point[0] = 1.0 / 3 + b * point[1];
        point[1] = 0.7 + b * old * old;
      }
      point[0] += lane * 0x1p-53;
    };
    const auto known = [&](int lane) { return std::fabs(contractions[lane]) + 0x1p-60; };
    lanes::Real given = 0;
    for (int lane = 0; lane < kCount; ++lane) {
      double point[2] = {0, 0};
      points(lane, point);
      for (int j = 0; j < 2; ++j) x[j].set(lane, point[j]);
      given.set(lane, known(lane));
    }
    // Lane 6 has no part in it.
    lanes::Real turns = 1;
    turns.set(6, 0);
    turn.begin(turns > 0);
    const auto map = [&](const lanes::Real& other, int j) {
      return j == 0 ? lanes::Real(1.0 / 3) + contraction * other
                    : lanes::Real(0.7) + contraction * other * other;
    };
    // The second use finds what the first one left behind.
    const lanes::Real begun[2] = {x[0], x[1]};
    for (int use = 0; use < 2; ++use) {
      for (int j = 0; j < 2; ++j) x[j] = begun[j];
      rule.learn(true, given);
      rule.begin(turn, 0);
      rule(moved_by(lanes::Real(16 * 0x1p-52)), 1);
      const lanes::Real nothing[2] = {0, 0};
      if (ruled) together.foresee(rule, x, nothing, nothing);
      refined(
          [&](auto& point, const auto& lack, const auto& slope) {
            return ruled ? together(turn, rule, point, lack, slope)
                         : together(turn, point, lack, slope);
          },
          map, x);
    }
    bool settled = false;
    for (int lane = 0; lane < kCount; ++lane) {
      of_double::Refinement<2, 2> alone;
      of_double::ContractionRule<1> other;
      double y[2] = {0, 0};
      points(lane, y);
      const double start[2] = {y[0], y[1]};
      const double b = contractions[lane];
      for (int use = 0; use < 2; ++use) {
        for (int j = 0; j < 2; ++j) y[j] = start[j];
        other.learn(known(lane));
        other.begin(0);
        other(moved_by(16 * 0x1p-52), 1);
        const double nothing[2] = {0, 0};
        if (ruled) alone.foresee(other, y, nothing, nothing);
        refined(
            [&](auto& point, const auto& lack, const auto& slope) {
              return ruled ? alone(other, point, lack, slope) : alone(point, lack, slope);
            },
            [&](double z, int j) { return j == 0 ? 1.0 / 3 + b * z : 0.7 + b * z * z; }, y);
      }
      for (int j = 0; j < 2; ++j) {
        EXPECT_EQ(x[j][lane], y[j]) << lane;
        EXPECT_EQ(together.slope[j][lane], lane == 6 ? 0 : alone.slope[j]) << lane;
        EXPECT_EQ(together.change[j][lane], lane == 6 ? 0 : alone.change[j]) << lane;
      }
      EXPECT_EQ(together.contraction[lane], lane == 6 ? 1 : alone.contraction) << lane;
      if (lane != 6 && ruled) {
        EXPECT_EQ(rule.contraction[lane], other.contraction) << lane;
      }
      settled = settled || (ruled && other.settled);
    }
    EXPECT_EQ(settled, ruled);
    EXPECT_EQ(together.rounds, 0);
  }
}

// An unknown that is small beside another, in each lane by another contraction and from another
// distance, some of them at its end: those go on that have to, as alone.
int expect_small_unknowns_end_alike(double large, int units, bool foresees = false) {
  const double contractions[kCount] = {0, 0.25, -0.9, 0.45, 0.1, -0.3, 0.4, 0.75};
  const auto begin = [&](int lane) { return 1 + (lane % 3) * units * 0x1p-52; };
  lanes::ContractionRule<1> rule;
  lanes::Refinement<2, 2> together;
  lanes::Turn turn = turn_of_all();
  lanes::Real turns = 1;
  turns.set(4, 0);
  turn.begin(turns > 0);
  lanes::Real b = 0;
  lanes::Real x[2] = {large, 0};
  for (int lane = 0; lane < kCount; ++lane) {
    b.set(lane, contractions[lane]);
    x[1].set(lane, begin(lane));
  }
  rule.contraction = 0x1p-20;
  rule.round_off = large * 0x1p-52;
  rule.settled = true;
  rule.sure = !foresees;
  together.untold = 0;
  // They turn back in a step that is behind another: what that knows of their ways is used.
  const auto ahead = [&](lanes::Real from) {
    const lanes::Real lack[2] = {0, (b - 1) * (x[1] - 1)};
    const lanes::Real start[2] = {0, from};
    together.foresee(rule, x, lack, start);
    for (int j = 0; j < 2; ++j) x[j] += lack[j];
  };
  const lanes::Real before[2] = {x[0], x[1]};
  if (foresees) ahead(0.75 + 0.25 * b);
  for (int j = 0; j < 2; ++j) x[j] = before[j];
  if (foresees) ahead(x[1]);
  for (bool more = true; more;) {
    const lanes::Real error = x[1] - 1;
    const lanes::Real lack[2] = {0, b * error - error};
    const lanes::Real slope[2] = {0, x[1]};
    more = together(turn, rule, x, lack, slope);
  }
  int settled = 0;
  for (int lane = 0; lane < kCount; ++lane) {
    of_double::ContractionRule<1> other;
    of_double::Refinement<2, 2> alone;
    double y[2] = {large, begin(lane)};
    other.contraction = 0x1p-20;
    other.round_off = large * 0x1p-52;
    other.settled = lane != 4;
    other.sure = !foresees;
    alone.untold = 0;
    const auto alone_ahead = [&](double from) {
      const double lack[2] = {0, (contractions[lane] - 1) * (y[1] - 1)};
      const double start[2] = {0, from};
      alone.foresee(other, y, lack, start);
      for (int j = 0; j < 2; ++j) y[j] += lack[j];
    };
    if (foresees) alone_ahead(0.75 + 0.25 * contractions[lane]);
    y[1] = begin(lane);
    if (foresees) alone_ahead(y[1]);
    for (bool more = lane != 4; more;) {
      const double error = y[1] - 1;
      const double lack[2] = {0, contractions[lane] * error - error};
      const double slope[2] = {0, y[1]};
      more = alone(other, y, lack, slope);
    }
    EXPECT_EQ(x[0][lane], y[0]) << lane;
    EXPECT_EQ(x[1][lane], y[1]) << lane;
    EXPECT_EQ(together.slope[1][lane], alone.slope[1]) << lane;
    EXPECT_EQ(together.change[1][lane], alone.change[1]) << lane;
    EXPECT_EQ(rule.settled[lane], other.settled) << lane;
    settled += other.settled ? 1 : 0;
  }
  return settled;
}
TEST(LaneRefinement, SmallUnknownsComeToTheirEndInEachLaneAsAlone) {
  const int settled = expect_small_unknowns_end_alike(1 << 20, 500);
  EXPECT_GE(settled, 4);
  EXPECT_LE(settled, 6);
}
TEST(LaneRefinement, SmallUnknownsAreForeseenInEachLaneAsAlone) {
  const int settled = expect_small_unknowns_end_alike(1 << 20, 4000, true);
  EXPECT_GE(settled, 2);
  EXPECT_LE(settled, 6);
}
// Steps in which each lane moves or turns back, is sure or not, and has a second unknown that is
// nothing beside the first or something: what its ways were is known to each as alone.
TEST(LaneRefinement, EachLaneKnowsItsWaysAsAlone) {
  constexpr double kUnit = 0x1p-52;
  const auto moves = [](int lane, int step) { return (lane * 5 + step * 3) % 4 != 0; };
  const auto is_sure = [](int lane, int step) { return (lane + 3 * step) % 5 == 0; };
  const auto small = [](int lane) { return lane % 2 == 0 ? kUnit : kUnit * kUnit * kUnit; };
  lanes::ContractionRule<1> rule;
  lanes::Refinement<2, 2> together;
  std::vector<of_double::ContractionRule<1>> others(kCount);
  std::vector<of_double::Refinement<2, 2>> alone(kCount);
  together.untold = 0;
  for (auto& each : alone) each.untold = 0;
  int settled = 0;
  int doubted = 0;
  for (int step = 0; step < 12; ++step) {
    lanes::Real x[2] = {1, 0}, from[2] = {1, 0}, increment[2] = {16 * kUnit, 0};
    lanes::Real lack[2] = {kUnit / 3, 0}, sure = 0;
    const lanes::Real slope[2] = {0, 0};
    // A third of a unit is missing of the first, three eighths of its way of the second one.
    for (int lane = 0; lane < kCount; ++lane) {
      x[1].set(lane, small(lane));
      from[0].set(lane, moves(lane, step) ? 0.5 : 1);
      from[1].set(lane, small(lane) / 2);
      increment[1].set(lane, small(lane) * 16 * kUnit);
      lack[1].set(lane, small(lane) * (lane % 3 == 0 ? 6 : 2) * kUnit);
      sure.set(lane, is_sure(lane, step) ? 1 : 0);
    }
    const lanes::Turn turn = turn_of_all();
    rule.contraction = 0x1p-20;
    rule.round_off = kUnit;
    rule.settled = true;
    rule.sure = sure > 0;
    const lanes::Real begun[2] = {x[0], x[1]};
    together.foresee(rule, x, increment, from);
    for (int j = 0; j < 2; ++j) x[j] += increment[j];
    (void)together(turn, rule, x, lack, slope);
    together.rounds = 0;
    for (int lane = 0; lane < kCount; ++lane) {
      of_double::ContractionRule<1>& other = others[lane];
      other.contraction = 0x1p-20;
      other.round_off = kUnit;
      other.settled = true;
      other.sure = is_sure(lane, step);
      double y[2], start[2], by[2], lacks[2];
      for (int j = 0; j < 2; ++j) {
        y[j] = begun[j][lane];
        start[j] = from[j][lane];
        by[j] = increment[j][lane];
        lacks[j] = lack[j][lane];
      }
      const double slopes[2] = {0, 0};
      alone[lane].foresee(other, y, by, start);
      for (int j = 0; j < 2; ++j) y[j] += by[j];
      (void)alone[lane](other, y, lacks, slopes);
      alone[lane].rounds = 0;
      EXPECT_EQ(rule.settled[lane], other.settled) << lane << " in step " << step;
      for (int j = 0; j < 2; ++j)
        EXPECT_EQ(together.ways[j][lane], alone[lane].ways[j]) << lane << " in step " << step;
      (other.settled ? settled : doubted) += 1;
    }
  }
  EXPECT_GT(settled, 30);
  EXPECT_GT(doubted, 20);
}
// Lanes at their end, where what follows a long increment is lost, wait for those that go ahead,
// and are not looked at as if they had gone, too.
TEST(LaneRefinement, WhatHasEndedIsNotDoubtedWhileOthersGoAhead) {
  constexpr double kUnit = 0x1p-52;
  lanes::ContractionRule<1> rule;
  lanes::Refinement<1, 1> together;
  lanes::Real x[1] = {1}, increment[1] = {0x1p24 * kUnit}, lack[1] = {6 * kUnit};
  const lanes::Real from[1] = {0}, slope[1] = {0};
  for (int lane = 0; lane < kCount; lane += 2) lack[0].set(lane, 32 * kUnit);
  rule.contraction = 0x1p-20;
  rule.round_off = 100 * kUnit;
  rule.settled = true;
  rule.sure = false;
  together.untold = 0;
  together.foresee(rule, x, increment, from);
  x[0] += increment[0];
  const lanes::Turn turn = turn_of_all();
  EXPECT_TRUE(together(turn, rule, x, lack, slope));
  for (int lane = 0; lane < kCount; lane += 2) lack[0].set(lane, 0);
  (void)together(turn, rule, x, lack, slope);
  for (int lane = 0; lane < kCount; ++lane) EXPECT_TRUE(rule.settled[lane]) << lane;
}
// What they lack is seen of all together, too, and more than 8 of their roundings.
TEST(LaneRefinement, UnknownsThatAreSeenEndInEachLaneAsAlone) {
  EXPECT_LE(expect_small_unknowns_end_alike(4, 30), 6);
}

// x = 1 + b (x - 1), from some units beside its solution: where it does not contract the solution
// is not found, and the next one is not told of it.
TEST(LaneRefinement, WhatDoesNotContractIsNotFoundInEachLaneAsAlone) {
  const double contractions[kCount] = {0.5, 1.02, -0.9, -1.25, 0, -0.5, 0x1p-30, -1};
  lanes::Refinement<1, 1> together;
  const auto begin = [](int lane) { return 1 + (lane + 3) * 0x1p-50; };
  for (const bool reversed : {false, true}) {
    const auto factor = [&](int lane) { return contractions[reversed ? kCount - 1 - lane : lane]; };
    lanes::Real contraction = 0;
    lanes::Real x[1] = {};
    for (int lane = 0; lane < kCount; ++lane) {
      contraction.set(lane, factor(lane));
      x[0].set(lane, begin(lane));
    }
    const lanes::Turn turn = turn_of_all();
    for (bool more = true; more;) {
      const lanes::Real way[1] = {x[0] - 1};
      const lanes::Real lack[1] = {contraction * way[0] - way[0]};
      more = together(turn, x, lack, way);
    }
    for (int lane = 0; lane < kCount; ++lane) {
      of_double::Refinement<1, 1> alone;
      double y[1] = {begin(lane)};
      for (bool more = true; more;) {
        const double way[1] = {y[0] - 1};
        const double lack[1] = {factor(lane) * way[0] - way[0]};
        more = alone(y, lack, way);
      }
      const double size = std::fabs(factor(lane));
      EXPECT_EQ(alone.found, size < 0.99) << factor(lane);
      EXPECT_EQ(together.found[lane], alone.found) << factor(lane);
    }
  }
}

// x = s + (x - s)/8 from 0, s a third of a unit of 1: rounded beside another length in each lane.
TEST(LaneRefinement, ALengthBesideCountsInEachLaneAsAlone) {
  const double lengths[kCount] = {0, 0x1p-40, 0x1p-12, 0x1p-8, 0x1p-4, 0x1p-2, 1, 0x1p+8};
  const double end = 0x1p-52 / 3;
  lanes::Refinement<1, 1, true> together;
  for (int lane = 0; lane < kCount; ++lane) together.beside.set(lane, lengths[lane]);
  const auto rounds = [&](auto& x, const auto& look) {
    int count = 0;
    for (bool more = true; more; ++count) {
      const std::remove_cvref_t<decltype(x[0])> lack[1] = {(end - x[0]) * 0.875};
      more = look(x, lack);
    }
    return count;
  };
  lanes::Real x[1] = {0};
  const int most = rounds(x, [&](auto& point, const auto& lack) {
    return together(turn_of_all(), point, lack, point);
  });
  std::set<int> counts;
  for (int lane = 0; lane < kCount; ++lane) {
    of_double::Refinement<1, 1, true> alone;
    alone.beside = lengths[lane];
    double y[1] = {0};
    counts.insert(
        rounds(y, [&](auto& point, const auto& lack) { return alone(point, lack, point); }));
    EXPECT_EQ(together.change[0][lane], alone.change[0]) << lane;
  }
  EXPECT_EQ(most, *counts.rbegin());
  EXPECT_GE(counts.size(), 3u);
}

TEST(LaneRefinement, WhatIsLostIsNotWaitedForInEachLaneAsAlone) {
  const double sizes[kCount] = {0, 0x1p-170, 0x1p-156, 0x1p-140, 0x1p-100, 0x1p-60, 1, 0x1p-157};
  lanes::Real size = 0;
  for (int lane = 0; lane < kCount; ++lane) size.set(lane, sizes[lane]);
  const lanes::Real zero = 0;
  const lanes::Real one = 1;
  lanes::Distance together;
  lanes::Distance of_array;
  together.add(size, zero);
  together.add(zero, one);
  of_array.add(&size, &zero, &zero, 1);
  of_array.add(&zero, &one, &zero, 1);
  lanes::Refinement<2, 2> refinement;
  const auto refine = [](auto& x, const auto& last, const auto& look) {
    for (bool more = true; more;) {
      const std::remove_cvref_t<decltype(last)> lack[2] = {0x1p-53 - (x[0] - 1) * 0.75,
                                                           (last - x[1]) * 0x1p-5};
      more = look(x, lack);
    }
  };
  lanes::Real x[2] = {1, 0};
  refine(x, size, [&](auto& point, const auto& lack) {
    return refinement(turn_of_all(), point, lack, point);
  });
  for (int lane = 0; lane < kCount; ++lane) {
    of_double::Distance alone;
    alone.add(sizes[lane], 0);
    alone.add(0, 1);
    EXPECT_EQ(together.near()[lane], alone.near()) << lane;
    EXPECT_EQ(of_array.near()[lane], alone.near()) << lane;
    EXPECT_EQ(alone.near(), sizes[lane] <= 0x1p-156) << lane;
    of_double::Refinement<2, 2> other;
    double y[2] = {1, 0};
    refine(y, sizes[lane],
           [&](auto& point, const auto& lack) { return other(point, lack, point); });
    EXPECT_EQ(refinement.change[1][lane], other.change[1]) << lane;
  }
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
