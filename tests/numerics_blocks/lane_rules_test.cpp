// The rules of a batch: an iteration ends in a lane where it would end for one trajectory alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {

namespace packs_of_rules {
#include "tests/numerics_blocks/packs.inc"
}  // namespace packs_of_rules

namespace {

namespace lanes = packs_of_rules;
using of_double::Verdict;
constexpr int kCount = 8;

// Increments of an iteration from its first on, the last one again and again.
struct Increments {
  std::string name;
  std::vector<double> sizes;
  [[nodiscard]] double at(int iteration) const {
    const auto i = static_cast<std::size_t>(iteration - 1);
    return i < sizes.size() ? sizes[i] : sizes.back();
  }
};

const std::vector<Increments>& all_increments() {
  static const double infinity = std::numeric_limits<double>::infinity();
  static const double nan = std::numeric_limits<double>::quiet_NaN();
  static const std::vector<Increments> list = {
      {"quadratic", {1e-2, 1e-4, 1e-8, 1e-16}},
      {"at once", {1e-17}},
      {"lost", {1e-3, nan}},
      {"never", {1, 0.99}},
      {"astray", {1e-3, 9e-4, 1e-9, 0}},
      {"stands still", {1e-3, 1e-13, 2e-13, 3e-13}},
      {"infinite", {1e300, infinity}},
      {"fast", {1e-5, 1e-12}},
      {"linear", {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12, 1e-15}},
      {"two sequences", {1e-2, 1e-9, 1e-3, 1e-10, 1e-5, 1e-14, 1e-9, 1e-15, 1e-13, 1e-16}},
      {"nothing", {0}},
      {"noise", {1e-6, 1e-14, 2e-14, 1e-14, 3e-14, 2e-14, 1e-14}},
      {"grows", {1e-9, 1e-8, 1e-7, 1e-6, 1e-5}},
      {"stalls", {6e-14, 6e-14, 7e-14, 5e-14, 7e-14, 4e-14, 7e-14, 3e-14, 1e-16}},
      {"slow and close", {1e-4, 0.6e-4, 0.4e-4, 1e-15}},
      {"slow", {1e-2, 6e-3, 3.5e-3, 2e-3, 1.2e-3, 7e-4, 4e-4, 2.5e-4, 1.5e-4, 1e-15}}};
  return list;
}
const Increments& increments_of(int batch, int lane) {
  return all_increments()[static_cast<std::size_t>(kCount * batch + lane)];
}

// How many iterations, and whether the end was a success.
struct End {
  int iterations = 0;
  bool done = false;
  bool operator==(const End&) const = default;
};
void PrintTo(const End& end, std::ostream* out) {
  *out << end.iterations << (end.done ? " done" : " failed");
}

// Of a rule that is asked by `ask`, from iteration 1 on.
template <class Ask>
End end_alone(const Increments& increments, const Ask& ask) {
  for (int iteration = 1;; ++iteration) {
    const Verdict verdict = ask(increments.at(iteration), iteration);
    if (verdict != Verdict::go_on) return {iteration, verdict == Verdict::done};
  }
}
// What stands in the lanes of the iteration of this number.
lanes::Real sizes_of(int batch, int iteration) {
  lanes::Real size = 0;
  for (int lane = 0; lane < kCount; ++lane)
    size.set(lane, increments_of(batch, lane).at(iteration));
  return size;
}
template <class Ask>
void ask_together(int batch, const Ask& ask) {
  int iteration = 1;
  while (any(ask(sizes_of(batch, iteration), iteration))) ++iteration;
}
End end_in(const lanes::Iteration& rule, int lane) {
  return {static_cast<int>(rule.taken[lane]), !rule.failed[lane]};
}
template <class Distance, class Number>
Distance distance_of(const Number& size) {
  Distance distance;
  distance.add(size, Number(1));
  return distance;
}
of_double::Distance moved_by(double size) { return distance_of<of_double::Distance>(size); }
lanes::Distance moved_by(const lanes::Real& size) { return distance_of<lanes::Distance>(size); }

// Not one of those in which all check their contraction.
lanes::Turn turn_of_all() {
  lanes::Turn turn;
  turn.begin(true);
  return turn;
}

template <int Power>
void expect_newton_ends_as_alone(double uneven) {
  for (const bool predicted : {false, true}) {
    for (const int batch : {0, 1}) {
      lanes::NewtonRule<Power> rule;
      rule.begin(predicted, turn_of_all());
      ask_together(batch, [&](const lanes::Real& size, int iteration) {
        return rule(size, lanes::Real(1), iteration, lanes::Real(uneven));
      });
      for (int lane = 0; lane < kCount; ++lane) {
        of_double::NewtonRule<Power> alone;
        alone.begin(predicted);
        const Increments& increments = increments_of(batch, lane);
        const End end = end_alone(increments, [&](double size, int iteration) {
          return alone(size, 1, iteration, uneven);
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
          for (std::size_t i = 0; i < flags.size(); ++i)
            EXPECT_EQ(together[i][lane], flags[i]) << increments.name << " " << i;
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
  lanes::WaitingNewtonRule<2> rule;
  rule.begin(false, turn);
  const lanes::Real solution[1] = {3};
  rule.watch(history, solution, 0, 1);
  for (int lane = 0; lane < kCount; ++lane)
    EXPECT_EQ(rule.motion.move[lane], 2 * used[lane]) << lane;
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

TEST(LaneRules, WhatALaneForgetsTheOthersKnow) {
  lanes::NewtonRule<2> rule;
  rule.contraction = 0.5;
  rule.motion.move = 1;
  lanes::Real lane_2 = 0;
  lane_2.set(2, 1);
  rule.forget(lane_2 > 0);
  EXPECT_EQ(rule.contraction[2], lanes::largest);
  EXPECT_EQ(rule.motion.move[2], 0);
  EXPECT_EQ(rule.contraction[1], 0.5);
  EXPECT_EQ(rule.motion.move[1], 1);
}

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

TEST(LaneRules, WhatRoundingLacksIsFoundInEachLaneAsAlone) {
  const double contractions[kCount] = {0x1p-20, -0x1p-22, 0, 0.5, 0x1p-4, -0.3, 0x1p-40, -0.5};
  lanes::Real contraction = 0;
  for (int lane = 0; lane < kCount; ++lane) contraction.set(lane, contractions[lane]);
  for (const bool ruled : {false, true}) {
    lanes::Refinement<2, 2> together;
    lanes::ContractionRule rule;
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
    rule.learn(true, given);
    rule.begin(turn, 0);
    rule(moved_by(lanes::Real(16 * 0x1p-52)), 1);
    const auto map = [&](const lanes::Real& other, int j) {
      return j == 0 ? lanes::Real(1.0 / 3) + contraction * other
                    : lanes::Real(0.7) + contraction * other * other;
    };
    refined(
        [&](auto& point, const auto& lack, const auto& slope) {
          return ruled ? together(turn, rule, point, lack, slope)
                       : together(turn, point, lack, slope);
        },
        map, x);
    bool settled = false;
    for (int lane = 0; lane < kCount; ++lane) {
      of_double::Refinement<2, 2> alone;
      of_double::ContractionRule other;
      other.learn(known(lane));
      other.begin(0);
      other(moved_by(16 * 0x1p-52), 1);
      double y[2] = {0, 0};
      points(lane, y);
      const double b = contractions[lane];
      refined(
          [&](auto& point, const auto& lack, const auto& slope) {
            return ruled ? alone(other, point, lack, slope) : alone(point, lack, slope);
          },
          [&](double z, int j) { return j == 0 ? 1.0 / 3 + b * z : 0.7 + b * z * z; }, y);
      for (int j = 0; j < 2; ++j) {
        EXPECT_EQ(x[j][lane], y[j]) << lane;
        EXPECT_EQ(together.slope[j][lane], lane == 6 ? 0 : alone.slope[j]) << lane;
        EXPECT_EQ(together.change[j][lane], lane == 6 ? 0 : alone.change[j]) << lane;
      }
      if (lane != 6 && ruled) {
        EXPECT_EQ(rule.contraction[lane], other.contraction) << lane;
      }
      settled = settled || (ruled && other.settled);
    }
    EXPECT_EQ(settled, ruled);
    EXPECT_EQ(together.rounds, 0);
  }
}

TEST(LaneRules, WhatIsLostIsNotWaitedForInEachLaneAsAlone) {
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
    EXPECT_EQ(together.close()[lane], alone.close()) << lane;
    EXPECT_EQ(of_array.close()[lane], alone.close()) << lane;
    EXPECT_EQ(alone.close(), sizes[lane] <= 0x1p-156) << lane;
    of_double::Refinement<2, 2> other;
    double y[2] = {1, 0};
    refine(y, sizes[lane],
           [&](auto& point, const auto& lack) { return other(point, lack, point); });
    EXPECT_EQ(refinement.change[1][lane], other.change[1]) << lane;
  }
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
