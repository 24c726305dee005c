// What Refinement sees behind the last increment that a rule has settled.
#include <cmath>

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
