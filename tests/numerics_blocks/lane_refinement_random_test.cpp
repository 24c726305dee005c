// Lanes that settle, go ahead, are doubted, refined or have no part in a step, at random: each as
// one trajectory alone.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/numerics_blocks/lane_rules.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

constexpr int kSize = 3;

class Chance {
 public:
  double part() { return std::uniform_real_distribution<double>(0, 1)(engine_); }
  bool of(double likely) { return part() < likely; }
  // 10^low to 10^high.
  double power(double low, double high) { return std::pow(10.0, low + (high - low) * part()); }

 private:
  std::mt19937 engine_{1};
};

// x_j = s_j + b_j (x_j - s_j) + c (x_{j-1} - s_{j-1}).
struct Equations {
  double solution[kSize], factor[kSize], coupling = 0;
};
Equations some_equations(Chance& chance) {
  Equations made;
  if (chance.of(0.5)) made.coupling = chance.power(-4, 0);
  for (int j = 0; j < kSize; ++j) {
    made.factor[j] = (chance.of(0.5) ? -0.9 : 0.9) * chance.power(-6, 0.05);
    const double size = chance.of(0.7)   ? 1.0
                        : chance.of(0.5) ? chance.power(-300, -280)
                                         : chance.power(-40, 0);
    made.solution[j] = chance.of(0.1) ? 0.0 : (0.5 + chance.part()) * size;
  }
  return made;
}
// Where one of them begins a step, and what a rule says of it.
struct Begin {
  double point[kSize], from[kSize], round_off = 0;
  bool has_part, sure, settled;
};
Begin some_begin(Chance& chance, const Equations& equations) {
  Begin made;
  made.has_part = chance.of(0.85);
  made.sure = chance.of(0.2);
  made.settled = chance.of(0.85);
  const double units = chance.power(-1, 4);
  for (int j = 0; j < kSize; ++j) {
    const double size = equations.solution[j];
    made.round_off += 0x1p-52 * size;
    made.point[j] = chance.of(0.1) ? size : size * (1 + units * (chance.part() - 0.5) * 0x1p-51);
    made.from[j] = chance.of(0.2) ? made.point[j] : size * 2 * chance.part();
  }
  return made;
}

template <class Number>
struct OnItsWay {
  Number factor[kSize], solution[kSize], coupling, x[kSize], from[kSize], lack[kSize];

  void look() {
    Number before = 0;
    for (int j = 0; j < kSize; ++j) {
      const Number error = x[j] - solution[j];
      lack[j] = factor[j] * error - error + coupling * before;
      before = error;
    }
  }
  // To the end of the step.
  template <class Rule, class Refinement, class Look>
  void refine(Rule& rule, Refinement& refinement, const Look& wants_more) {
    look();
    refinement.foresee(rule, x, lack, from);
    for (int j = 0; j < kSize; ++j) x[j] += lack[j];
    int looks = 0;
    for (bool more = true; more && looks < 3000; ++looks) {
      look();
      const Number slope[kSize] = {x[0] * x[1], x[1], x[2]};
      more = wants_more(x, lack, slope);
    }
    EXPECT_LT(looks, 3000);
  }
};

struct Lane {
  of_double::ContractionRule<1> rule;
  of_double::Refinement<kSize, kSize> refinement;
  Equations equations;
};

TEST(LaneRefinement, IsAsAloneWhateverHappens) {
  Chance chance;
  long settled = 0;
  long refined = 0;
  for (int trajectory = 0; trajectory < 100; ++trajectory) {
    lanes::ContractionRule<1> rule;
    lanes::Refinement<kSize, kSize> together;
    std::vector<Lane> alone(kCount);
    for (Lane& lane : alone) lane.equations = some_equations(chance);
    for (int step = 0; step < 40; ++step) {
      OnItsWay<lanes::Real> all = {};
      lanes::Real has_part = 0, sure = 0, ends = 0, round_off = 0;
      std::vector<Begin> begins;
      for (int l = 0; l < kCount; ++l) {
        const Equations& equations = alone[l].equations;
        const Begin& begin = begins.emplace_back(some_begin(chance, equations));
        for (int j = 0; j < kSize; ++j) {
          all.factor[j].set(l, equations.factor[j]);
          all.solution[j].set(l, equations.solution[j]);
          all.x[j].set(l, begin.point[j]);
          all.from[j].set(l, begin.from[j]);
        }
        all.coupling.set(l, equations.coupling);
        has_part.set(l, begin.has_part ? 1 : 0);
        sure.set(l, begin.sure ? 1 : 0);
        ends.set(l, begin.settled ? 1 : 0);
        round_off.set(l, begin.round_off);
      }
      lanes::Turn turn = turn_of_all();
      turn.begin(has_part > 0);
      rule.contraction = 0x1p-20;
      rule.round_off = round_off;
      rule.settled = has_part * ends > 0;
      rule.sure = sure > 0;
      all.refine(rule, together, [&](auto& x, const auto& lack, const auto& slope) {
        return together(turn, rule, x, lack, slope);
      });
      for (int l = 0; l < kCount; ++l) {
        const Begin& begin = begins[l];
        if (!begin.has_part) continue;
        Lane& lane = alone[l];
        OnItsWay<double> one = {};
        for (int j = 0; j < kSize; ++j) {
          one.factor[j] = lane.equations.factor[j];
          one.solution[j] = lane.equations.solution[j];
          one.x[j] = begin.point[j];
          one.from[j] = begin.from[j];
        }
        one.coupling = lane.equations.coupling;
        lane.rule.contraction = 0x1p-20;
        lane.rule.round_off = begin.round_off;
        lane.rule.settled = begin.settled;
        lane.rule.sure = begin.sure;
        one.refine(lane.rule, lane.refinement, [&](auto& x, const auto& lack, const auto& slope) {
          return lane.refinement(lane.rule, x, lack, slope);
        });
        (lane.rule.settled ? settled : refined) += 1;
        const auto place = testing::Message()
                           << "lane " << l << " of " << trajectory << ", " << step;
        ASSERT_EQ(rule.settled[l], lane.rule.settled) << place;
        ASSERT_EQ(together.untold[l], lane.refinement.untold) << place;
        ASSERT_EQ(together.found[l], lane.refinement.found) << place;
        for (int j = 0; j < kSize; ++j) {
          ASSERT_EQ(all.x[j][l], one.x[j]) << place;
          ASSERT_EQ(together.slope[j][l], lane.refinement.slope[j]) << place;
          ASSERT_EQ(together.change[j][l], lane.refinement.change[j]) << place;
          ASSERT_EQ(together.ways[j][l], lane.refinement.ways[j]) << place;
          ASSERT_EQ(together.longest[j][l], lane.refinement.longest[j]) << place;
          ASSERT_EQ(together.spans[j][l], lane.refinement.spans[j]) << place;
          ASSERT_EQ(together.shrinks[j][l], lane.refinement.shrinks[j]) << place;
        }
      }
    }
  }
  EXPECT_GT(settled, 5000);
  EXPECT_GT(refined, 5000);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
