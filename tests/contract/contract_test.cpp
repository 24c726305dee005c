// Emitted and compiled steps do what the interpreted ones do that sweep_test.cpp measures, and what
// is measured would be seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include "tests/contract/interpreted.hpp"
#include "tests/contract/measure.hpp"

namespace hamgen::contract {
namespace {

Case case_of(const std::string& name, const std::string& scene, const Request& request,
             long steps) {
  return {.name = name + " " + scene + " " + request.scheme.text() + request.solver.text(),
          .model = model(name),
          .scene = scene,
          .request = request,
          .steps = steps};
}

// The same operations in the same order: Newton, a fixed point, stages, substeps, loops.
TEST(CompiledSteps, HaveTheDefectsOfInterpretedOnes) {
  const std::vector<Case> cases = {
      case_of("wall", "bounce", {}, 700),
      case_of("box", "soft", {.solver = "fixed-point"}, 700),
      case_of("box", "soft", {.scheme = "gauss-4"}, 500),
      case_of("morse_approach", "far", {.scheme = "yoshida-4"}, 300),
      case_of("wall", "bounce", {.scheme = "stormer-verlet"}, 300),
      case_of("harmonic", "stiff", {.alpha = "3/10", .beta = "1/5", .gamma = "-1/10"}, 300),
      case_of("box", "soft", {.scalar = "long-double"}, 300),
      case_of("hard_beads", "shot", {}, 100),
      case_of("row", "two", {.scheme = "sofroniou-spaletta-10"}, 100),
      case_of("hard_beads", "shot", {.scheme = "sofroniou-spaletta-10", .solver = "newton"}, 60)};
  const std::vector<Defects> compiled = measure(cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Defects& d = compiled[i];
    const Defects interpreted = Interpretable(cases[i].model).measure(cases[i]);
    EXPECT_FALSE(d.failed) << d.name << " after step " << d.steps;
    EXPECT_LE(d.worst, kAllowed) << d.name << " at step " << d.worst_step;
    EXPECT_LE(d.reference, 1e-9) << d.name;
    EXPECT_EQ(d.unknown, 0) << d.name;
    EXPECT_EQ(d.solves, interpreted.solves) << d.name;
    EXPECT_EQ(d.iterations, interpreted.iterations) << d.name;
    // Six digits are printed.
    EXPECT_NEAR(d.units, interpreted.units, 1e-5 * interpreted.units) << d.name;
    EXPECT_NEAR(d.worst, interpreted.worst, 1e-5 * interpreted.worst) << d.name;
  }
}

// Each lane decides for itself when its equations are solved, by rules of its own blocks.
void expect_kept_in_lanes(const std::vector<Case>& cases) {
  for (const Defects& d : measure(cases)) {
    EXPECT_FALSE(d.failed) << d.name << " after step " << d.steps;
    EXPECT_LE(d.worst, kAllowed) << d.name << " at step " << d.worst_step;
    EXPECT_LE(d.reference, 1e-9) << d.name;
    EXPECT_EQ(d.broken, 0) << d.name;
    EXPECT_EQ(d.unknown, 0) << d.name;
    EXPECT_GT(d.solves, 0) << d.name;
  }
}
TEST(StepsInLanes, KeepTheContract) {
  expect_kept_in_lanes({case_of("wall", "bounce", {.batch = 2}, 700),
                        case_of("box", "soft", {.solver = "fixed-point", .batch = 2}, 700)});
}
TEST(StepsInLanes, KeepTheContractByOtherMethods) {
  expect_kept_in_lanes(
      {case_of("box", "soft", {.scheme = "gauss-4", .batch = 2}, 500),
       case_of("wall", "bounce", {.scheme = "gauss-4", .solver = "newton", .batch = 2}, 700),
       case_of("morse_approach", "far", {.scheme = "yoshida-4", .batch = 2}, 300),
       case_of("wall", "bounce", {.scheme = "stormer-verlet", .batch = 2}, 300),
       case_of("harmonic", "stiff", {.alpha = "3/10", .beta = "1/5", .gamma = "-1/10", .batch = 2},
               300),
       case_of("hard_beads", "shot", {.batch = 2}, 100),
       case_of("one_small", "slow", {.batch = 2}, 100),
       case_of("row", "two", {.scheme = "kahan-li-8b", .batch = 2}, 150),
       case_of("next_to_rounding", "still", {.scheme = "gauss-4", .batch = 2}, 20),
       case_of("two_near_rest", "small", {.batch = 2}, 100),
       case_of("ring_near_rest", "tiny", {.scheme = "gauss-4", .batch = 2}, 20)});
}
TEST(StepsInLanes, KeepTheContractOfQuietUnknownsBesideLoudOnes) {
  expect_kept_in_lanes({case_of("free_wall", "harder", {.batch = 2}, 400),
                        case_of("two_walls", "once", {.batch = 2}, 1200),
                        case_of("saddle", "fall", {.batch = 2}, 40),
                        case_of("beside_huge", "away", {.batch = 2}, 100),
                        case_of("heavy", "million", {.batch = 2}, 200),
                        case_of("ripple", "beside", {.batch = 2}, 300),
                        case_of("together", "fast", {.batch = 2}, 60),
                        case_of("together", "stiff", {.batch = 2}, 80),
                        case_of("in_flight", "quiet", {.batch = 2}, 60),
                        case_of("in_flight_beside", "still", {.batch = 2}, 80),
                        case_of("in_flight", "far", {.batch = 2}, 20)});
}

// A step without the carry solves its equations as well: it rounds the state, and no more.
TEST(PlainSums, KeepTheContract) {
  for (const Request& request :
       {Request{.plain_sums = true}, Request{.solver = "fixed-point", .plain_sums = true},
        Request{.scheme = "gauss-4", .plain_sums = true},
        Request{.scheme = "stormer-verlet", .plain_sums = true}}) {
    for (const auto& [name, scene] : {std::pair{"wall", "bounce"}, std::pair{"box", "soft"}}) {
      const Case c = case_of(name, scene, request, 500);
      const Defects d = Interpretable(c.model).measure(c);
      EXPECT_FALSE(d.failed) << d.name;
      EXPECT_LE(d.worst, kAllowed) << d.name << " at step " << d.worst_step;
      EXPECT_EQ(d.broken, 0) << d.name;
    }
  }
}

// The force on y is solved for first, and then moves x too: what its last increment added is in it
// then, and is not added again.
TEST(ABlockBehindAnother, TakesTheIncrementOfThatOneOnce) {
  const Case c{.name = "two pendulums",
               .model = make_source("two.ham",
                                    "system two\ncoordinate x, y\nmomentum u, v\n"
                                    "H = (u^2 + v^2)/2 - cos(x) - 2*cos(y)\n"
                                    "scene s { x = 2; y = 1.5; u = 0.3; h = 0.1; steps = 500 }\n"),
               .scene = "s",
               .request = {.gauge = "[[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1/3], [0, 0, 0, 0]]",
                           .solver = "newton"}};
  const Defects d = Interpretable(c.model).measure(c);
  EXPECT_FALSE(d.failed);
  EXPECT_EQ(d.steps, 500);
  EXPECT_LE(d.worst, kAllowed) << "at step " << d.worst_step;
  EXPECT_EQ(d.broken, 0);
}

// Negative controls, of emitted text in which each of these is something else.
using Instead = std::vector<std::pair<std::string, std::string>>;
std::function<std::string(std::string)> with(const Instead& changes) {
  return [changes](std::string text) {
    for (const auto& [look, put] : changes) {
      const auto at = text.find(look);
      EXPECT_NE(at, std::string::npos) << look;
      if (at != std::string::npos) text.replace(at, look.size(), put);
    }
    return text;
  };
}

// With the rule as strict as it was before its bias was seen: as it is that stands for some of the
// other reasons.
std::function<std::string(std::string)> with_less_strict(Instead changes) {
  const Instead less = {
      {"bend_of(size) * power(size) * 1048576", "bend_of(size) * power(size) * 1024"},
      {"64 * epsilon * seen.shortest", "65536 * epsilon * seen.shortest"},
      {"size * size * 16384 <= epsilon * length;", "size * size * 16 <= epsilon * length;"},
      {"size * size * 16384 <= epsilon * length * One",
       "size * size * 16 <= epsilon * length * One"},
      {"uneven * 16384 <= epsilon", "uneven * 16 <= epsilon"},
      {"contraction * parts * 16384", "contraction * parts * 16"},
      {"(size) * parts * 16384", "(size) * parts * 16"}};
  changes.insert(changes.end(), less.begin(), less.end());
  const auto asks_each = [](const auto& change) { return change.first.starts_with("bend * part"); };
  if (std::ranges::none_of(changes, asks_each))
    changes.emplace_back("bend * part * part * 16384", "bend * part * part * 16");
  return with(changes);
}

TEST(ContractIsBroken, WhereTheSumOfAllIncrementsIsAskedAlone) {
  const auto forget_each =
      with_less_strict({{"uneven <= 0 || is_even(", "uneven >= 0 || is_even("},
                        {"bend * part * part * 16384 > round_off * move * move", "part < 0"},
                        {"least < 8 * round_off ? least :", "false ? least :"},
                        {"least < round_off ? least :", "false ? least :"},
                        {"if (fresh <= 0) return;", "if (fresh > 0) --fresh; return;"},
                        {"size * size * size <= epsilon * round_off", "size >= 0"}});
  const Case beads = case_of("row", "two", {.scheme = "sofroniou-spaletta-10"}, 200);
  EXPECT_LE(Interpretable(beads.model).measure(beads).worst, kAllowed);
  EXPECT_EQ(measure({beads}, with_less_strict({})).at(0).broken, 0);
  EXPECT_GE(measure({beads}, forget_each).at(0).broken, 1);
}

TEST(ContractIsBroken, WhereAllUnknownsHaveOneUnit) {
  const auto forget_units = with_less_strict(
      {{"1 / (size_of(length[j], moved[j]) + total / 1099511627776 + smallest)", "1"},
       {"if (++age >= 16) follow(value, count);", ""},
       {"bend * part * part * 16384 > round_off * move * move", "part < 0"},
       {"* ratio * ratio", "* ratio * 0"}});
  const Case c = case_of("unlike_units", "small", {}, 100);
  EXPECT_LE(Interpretable(c.model).measure(c).worst, kAllowed);
  EXPECT_EQ(measure({c}, with_less_strict({})).at(0).broken, 0);
  const Defects d = measure({c}, forget_units).at(0);
  EXPECT_GE(d.worst, 100 * kAllowed);
  EXPECT_GE(d.broken, 1);
}

// A quiet unknown beside a loud one.
struct Hole {
  Case c;
  Instead changes;
};
void expect_broken(std::span<const Hole> holes) {
  for (const Hole& hole : holes) {
    EXPECT_LE(Interpretable(hole.c.model).measure(hole.c).worst, kAllowed) << hole.c.name;
    EXPECT_EQ(measure({hole.c}, with_less_strict({})).at(0).broken, 0) << hole.c.name;
    EXPECT_GE(measure({hole.c}, with_less_strict(hole.changes)).at(0).broken, 1) << hole.c.name;
  }
}
TEST(ContractIsBroken, WhereNoUnknownIsAskedByItself) {
  const Hole holes[] = {{case_of("free_wall", "harder", {}, 400),
                         {{"bend * part * part * 16384 > round_off * move * move", "part < 0"}}},
                        {case_of("saddle", "fall", {}, 40),
                         {{"* ratio * ratio", "* ratio * 0"},
                          {"size * size * size <= epsilon * round_off", "size >= 0"}}}};
  expect_broken(holes);
}
// Of each reason that a rule has for this, one that does without.
TEST(ContractIsBroken, WhereOneOfTheReasonsIsLeftOut) {
  const Hole holes[] = {
      {case_of("in_flight", "far", {}, 20),
       {{"if (fresh > 0) return", "if (fresh > 9) return"},
        {"this->unchecked += 32;", ""},
        {"Power == 2 && 1024 * this->contraction < 1", "false"},
        {"size * size * size <= epsilon * round_off", "size >= 0"}}},
      {case_of("in_flight", "quiet", {}, 60),
       {{"this->unchecked += 32;", ""}, {"Power == 2 && 1024 * this->contraction < 1", "false"}}},
      {case_of("in_flight_beside", "still", {}, 80), {{"slowest};\n    doubt();", "slowest};"}}},
      {case_of("together", "stiff", {}, 80),
       {{"size * size * size <= epsilon * round_off", "size >= 0"}}},
      {case_of("together", "fast", {}, 60),
       {{"magnitude(sum[j]) / turns[j]", "Real(1)"},
        {"Power == 2 && 1024 * this->contraction < 1", "false"},
        {"size * size * size <= epsilon * round_off", "size >= 0"}}},
      {case_of("beside_huge", "away", {}, 60), {{"return !converging;", "return true;"}}}};
  expect_broken(holes);
}

TEST(ContractIsBroken, ByARuleThatOnlyRemembers) {
  // It learns its contraction in free flight and believes it at the wall.
  const auto forget_the_motion =
      with({{"return bend_of(size) * power(size) * 1048576 <= round_off * power(move);",
             "return true;"}});
  for (const Case& c : {case_of("wall", "bounce", {}, 700), case_of("box", "soft", {}, 700)}) {
    const Defects d = measure({c}, forget_the_motion).at(0);
    EXPECT_GE(d.worst, 1e6) << d.name;
    EXPECT_GE(d.broken, 1) << d.name;
  }
}

TEST(ContractIsBroken, InLanesByARuleThatOnlyRemembers) {
  const auto forget_the_motion = with(
      {{"is_next_lost(size, round_off) & is_straight(size, Many ? 8 * round_off : seen_in(scale))",
        "is_next_lost(size, round_off)"}});
  const Defects d =
      measure({case_of("wall", "bounce", {.batch = 2}, 700)}, forget_the_motion).at(0);
  EXPECT_GE(d.worst, 100 * kAllowed);
  EXPECT_GE(d.broken, 1);
}

// In a hard box the polynomial of the stages before leads where no iteration comes back from; the
// state itself does not.
TEST(ContractIsBroken, ByGaussThatDoesNotTryAgainFromTheStateItself) {
  const Case hard =
      case_of("hard_box", "coarse", {.scheme = "gauss-10", .solver = "fixed-point"}, 0);
  const Defects kept = Interpretable(hard.model).measure(hard);
  EXPECT_FALSE(kept.failed);
  EXPECT_LE(kept.worst, kAllowed);
  EXPECT_LE(kept.reference, 1e-9);
  const auto only_once = with({{"if (!report.converged && known)", "if (false)"}});
  const Defects once = measure({hard}, only_once).at(0);
  EXPECT_TRUE(once.failed);
}

}  // namespace
}  // namespace hamgen::contract
