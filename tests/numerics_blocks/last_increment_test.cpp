// What Refinement sees behind the last increment that a rule has settled.
#include <cmath>
#include <utility>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class LastIncrement : public ::testing::Test {
 protected:
  using Number = typename Blocks::Scalar;
  using Rule = typename Blocks::template Contraction<1>;

  // It contracts by 2^-14, and the last increment was 16 units of rounding of a solution 1.
  static Rule settled() {
    Rule rule;
    rule.learn(Number(0x1p-14));
    settle(rule);
    return rule;
  }
  static void settle(Rule& rule) {
    rule.begin(0);
    typename Blocks::Moved distance;
    distance.units = 64;  // in float, too
    distance.add(16 * Blocks::unit, Number(1));
    EXPECT_EQ(rule(distance, 1), Blocks::Answer::done);
    EXPECT_TRUE(rule.settled && !rule.sure);
  }
};
TYPED_TEST_SUITE(LastIncrement, EveryScalar);

// x = a + c x of two unknowns behind increments of 16 units and a third, the third taken by
// rounding: the rule is believed only where what follows each of them shows that it is lost,
// however large the other one is.
TYPED_TEST(LastIncrement, IsBelievedWhereWhatFollowsEachShowsIt) {
  using Real = typename TypeParam::Scalar;
  const Real third = TypeParam::unit / 3;
  const Real large = 1 << 20;
  const auto ends_at_once = [&](double contraction, double from, bool looks = true) {
    auto rule = this->settled();
    rule.round_off = large * TypeParam::unit;
    typename TypeParam::template Refined<2, 2> refinement;
    refinement.untold = 0;
    Real point[2] = {1, large};
    const Real start[2] = {Real(from), large / 2};
    Real increment[2] = {16 * TypeParam::unit + third, large * (16 * TypeParam::unit + third)};
    if (looks) refinement.foresee(rule, point, increment, start);
    for (int j = 0; j < 2; ++j) point[j] += increment[j];
    const Real slope[2] = {0, 0};
    const Real lack[2] = {third + Real(contraction) * 16 * TypeParam::unit, large * third};
    return !refinement(rule, point, lack, slope);
  };
  EXPECT_TRUE(ends_at_once(0x1p-10, 0.5));
  // What rounding took, a third of a unit, is more than four roundings of a way of a 16th.
  EXPECT_TRUE(ends_at_once(0x1p-10, 1 - 0x1p-4));
  EXPECT_FALSE(ends_at_once(0x1p-2, 0.5)) << "more than the noise of the equations";
  EXPECT_FALSE(ends_at_once(0x1p-10, 1)) << "where it has not moved";
  EXPECT_FALSE(ends_at_once(0x1p-10, 0.5, false)) << "where nothing was foreseen";
}

// Where an unknown turns back its way is none, and what the terms of that are rounded by is seen in
// the way of the step before; behind two such steps nothing is, nor where it begins anew.
TYPED_TEST(LastIncrement, KnowsTheRoundingOfATurnFromTheStepBefore) {
  using Real = typename TypeParam::Scalar;
  auto rule = this->settled();
  typename TypeParam::template Refined<1, 1> refinement;
  const auto ends_at_once = [&](double from) {
    refinement.untold = 0;
    this->settle(rule);
    Real point[1] = {1};
    const Real start[1] = {Real(from)};
    const Real increment[1] = {16 * TypeParam::unit};
    refinement.foresee(rule, point, increment, start);
    point[0] += increment[0];
    const Real slope[1] = {0};
    const Real lack[1] = {TypeParam::unit / 3};
    const bool more = refinement(rule, point, lack, slope);
    refinement.rounds = 0;
    return !more;
  };
  EXPECT_FALSE(ends_at_once(1));
  EXPECT_TRUE(ends_at_once(0.5));
  EXPECT_TRUE(ends_at_once(1));
  EXPECT_FALSE(ends_at_once(1));
  EXPECT_TRUE(ends_at_once(0.5));
  refinement.forget();
  EXPECT_FALSE(ends_at_once(1));
}

// An unknown of a part of the others' rounding is not told from its end by what the rounding of
// their rounding is; of one that goes ahead the doubt stays: within some roundings of its way what
// follows shows no contraction.
TYPED_TEST(LastIncrement, BelievesWhatFollowsBehindTheLastIncrementOfAll) {
  using Real = typename TypeParam::Scalar;
  const Real unit = TypeParam::unit;
  const auto evaluations_with = [&](Real small, double contraction) {
    auto rule = this->settled();
    typename TypeParam::template Refined<2, 2> refinement;
    refinement.untold = 0;
    Real point[2] = {1, small * (1 + 4096 * unit)};
    const Real start[2] = {Real(0.5), small / 2};
    const auto lacks = [&](Real* lack) {
      const Real error = point[1] - small;
      lack[0] = 0;
      lack[1] = Real(contraction) * error - error;
    };
    Real lack[2];
    lacks(lack);
    refinement.foresee(rule, point, lack, start);
    for (int j = 0; j < 2; ++j) point[j] += lack[j];
    const Real slope[2] = {0, 0};
    int evaluations = 0;
    for (bool more = true; more && evaluations < 100; ++evaluations) {
      lacks(lack);
      more = refinement(rule, point, lack, slope);
    }
    return rule.settled ? evaluations : -evaluations;
  };
  EXPECT_LT(evaluations_with(unit, 0x1p-4), -3) << "what went ahead has come to its end";
  EXPECT_LT(evaluations_with(unit, 0.75), -1) << "what went ahead is far from its end";
  EXPECT_EQ(evaluations_with(unit * unit * unit, 0x1p-4), 1) << "that is nothing beside the other";
}

// What follows a long increment is lost with the next one, and yet more than rounding: it goes
// ahead, and ends there, for there was no doubt.
TYPED_TEST(LastIncrement, GoesAheadWithoutADoubtWhereNoneWas) {
  using Real = typename TypeParam::Scalar;
  auto rule = this->settled();
  rule.round_off = 1024 * TypeParam::unit;
  typename TypeParam::template Refined<1, 1> refinement;
  refinement.untold = 0;
  Real point[1] = {1};
  const Real start[1] = {0};
  const Real increment[1] = {-(1 << 21) * TypeParam::unit};
  refinement.foresee(rule, point, increment, start);
  point[0] += increment[0];
  const Real slope[1] = {0};
  Real lack[1] = {10 * TypeParam::unit};
  EXPECT_TRUE(refinement(rule, point, lack, slope));
  lack[0] = 0;
  EXPECT_FALSE(refinement(rule, point, lack, slope));
  EXPECT_TRUE(rule.settled);
}

// What an increment of 16 units leaves behind what is seen, of a way of a half, is known by how
// errors shrink; an unknown that grows may leave more, and in every 48th step it is asked again.
TYPED_TEST(LastIncrement, IsBelievedAsErrorsShrinkWhereTheyAreNotSeen) {
  using Real = typename TypeParam::Scalar;
  auto rule = this->settled();
  typename TypeParam::template Refined<2, 2> refinement;
  refinement.untold = 0;
  const auto ends_at_once = [&](double shrinks, int units = 16) {
    rule.unchecked = 0;
    this->settle(rule);
    refinement.shrinks[0] = Real(shrinks);
    Real point[2] = {1, 0};
    const Real start[2] = {Real(0.5), 0};
    const Real increment[2] = {units * TypeParam::unit, 0};
    refinement.foresee(rule, point, increment, start);
    point[0] += increment[0];
    const Real slope[2] = {0, 0};
    const Real lack[2] = {Real(shrinks) * increment[0], 0};
    const bool more = refinement(rule, point, lack, slope);
    refinement.rounds = 0;
    return !more;
  };
  EXPECT_TRUE(ends_at_once(0x1p-6)) << "its way has been gained in this step";
  EXPECT_FALSE(ends_at_once(0x1p-6)) << "less than some roundings of its way, and it counts";
  EXPECT_FALSE(ends_at_once(0x1p-9));
  EXPECT_FALSE(ends_at_once(0x1p-6, 3));
  EXPECT_TRUE(ends_at_once(0x1p-6, 2)) << "a rounding or two have a sign by chance";
  for (int step = 6; step < 48; ++step) EXPECT_TRUE(ends_at_once(0x1p-10)) << step;
  EXPECT_FALSE(ends_at_once(0x1p-10)) << "it is long ago that rounds told it";
  refinement.untold = 0;
  EXPECT_TRUE(ends_at_once(0x1p-10));
  refinement.forget();
  EXPECT_EQ(refinement.shrinks[0], 0);
  EXPECT_FALSE(ends_at_once(0x1p-10));
}

// x = 1 + c (x - 1), and beside it y = c (x - 1 + y), which comes from 1 to nearly nothing: its
// errors are not those of so little.
TYPED_TEST(LastIncrement, KnowsHowErrorsShrinkByRounds) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template Refined<2, 2> refinement;
  const auto refine = [&](double contraction, double small, bool doubted = false,
                          double share = 0) {
    auto rule = this->settled();
    rule.settled = doubted;
    Real point[2] = {1 + 4 * TypeParam::unit, Real(small)};
    point[1] += Real(share) * (point[0] - 1);
    for (bool more = true; more;) {
      const Real error = point[0] - 1;
      const Real beside = point[1] - Real(small);
      const Real lack[2] = {Real(contraction) * error - error,
                            Real(contraction) * (error + beside) - beside};
      const Real slope[2] = {0, 0};
      more = refinement(rule, point, lack, slope);
    }
    return refinement.untold == 0;
  };
  EXPECT_TRUE(refine(0x1p-6, 1));
  EXPECT_NEAR(double(refinement.shrinks[0]), 0x1p-6, 0x1p-10);
  for (int step = 1; step < 4; ++step)
    EXPECT_FALSE(refine(0x1p-8, 1, true)) << "it has just been told";
  EXPECT_FALSE(refine(0x1p-8, 1)) << "it is not asked for";
  EXPECT_TRUE(refine(0x1p-8, 1, true));
  EXPECT_NEAR(double(refinement.shrinks[0]), (3 * 0x1p-6 + 0x1p-8) / 4, 0x1p-10);
  for (int step = 1; step < 32 * 16; ++step) {
    EXPECT_EQ(refine(0x1p-8, 0x1p-20), step % 16 == 0) << step;
  }
  EXPECT_NEAR(double(refinement.shrinks[0]), 0x1p-8, 0x1p-11);
  EXPECT_LT(double(refinement.shrinks[1]), 0x1p-3);
  typename TypeParam::template Refined<2, 2> anew;
  std::swap(refinement, anew);
  EXPECT_TRUE(refine(0x1p-6, 0x1p-20, false, 0x1p-6));
  EXPECT_EQ(refinement.shrinks[1], 1) << "no more than all";
}

// Beside a large unknown a small one counts for nothing in the sums: where it has not come to its
// end all go on, and where that brings it no nearer fast enough, Refinement does.
TYPED_TEST(LastIncrement, SettlesNoUnknownThatIsSmallBesideOthers) {
  using Real = typename TypeParam::Scalar;
  for (const double contraction : {0.0, 0.25, -0.9}) {
    auto rule = this->settled();
    rule.round_off = (1 << 20) * TypeParam::unit;
    rule.sure = true;
    typename TypeParam::template Refined<2, 2> refinement;
    Real point[2] = {1 << 20, 1 + 1000 * TypeParam::unit};
    int evaluations = 0;
    for (bool more = true; more; ++evaluations) {
      const Real error = point[1] - 1;
      const Real lack[2] = {0, Real(contraction) * error - error};
      const Real slope[2] = {0, point[1]};
      more = refinement(rule, point, lack, slope);
    }
    const bool shrinks = contraction > -0.5;
    EXPECT_EQ(rule.settled, shrinks) << contraction;
    EXPECT_GT(evaluations, 1) << contraction;
    EXPECT_EQ(point[0], Real(1 << 20)) << contraction;
    const Real solution = refinement.slope[1] + refinement.change[1];
    EXPECT_LE(std::fabs(double((solution - 1) / TypeParam::unit)), shrinks ? 8 : 1) << contraction;
    EXPECT_EQ(refinement.change[1] == 0, shrinks) << contraction;
    EXPECT_EQ(refinement.behind, 0) << contraction;
  }
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
