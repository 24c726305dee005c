// When the fixed point of a step is left as it is, when Refinement goes on, and when Newton takes
// over.
#include <cmath>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class ContractionRule : public ::testing::Test {
 protected:
  using Number = typename Blocks::Scalar;
  using Answer = typename Blocks::Answer;
  using Rule = typename Blocks::template Contraction<1>;
  using RuleOfTwo = typename Blocks::template Contraction<2>;

  template <class Chosen = Rule>
  static Chosen with_contraction(double contraction, int work = 0) {
    Chosen rule;
    rule.learn(Number(contraction));
    rule.begin(work);
    return rule;
  }
  // An increment of so many units of rounding of a solution 1.
  template <class Chosen>
  static Answer show(Chosen& rule, double units, int iteration) {
    typename Blocks::Moved distance;
    distance.units = 64;  // in float, too
    distance.add(Number(units) * Blocks::unit, Number(1));
    return rule(distance, iteration);
  }
};
TYPED_TEST_SUITE(ContractionRule, EveryScalar);

// 2^-14 squared, 16 units and the safety 2^20 are 2^-4 units.
TYPED_TEST(ContractionRule, SettlesWhatIsLostWithTheSafety) {
  auto rule = this->with_contraction(1.0 / (1 << 14));
  EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::done);
  EXPECT_TRUE(rule.settled);
}

// Of two unknowns one is far from its end: what is told of both together may not be true of it.
TYPED_TEST(ContractionRule, IsSureOnlyWhereEachUnknownWasNear) {
  using Number = typename TestFixture::Number;
  const auto of_both = [](double loud) {
    typename TypeParam::Moved distance;
    distance.units = 64;
    distance.add(Number(0.01) * TypeParam::unit, Number(9));
    distance.add(Number(loud) * TypeParam::unit, Number(1));
    return distance;
  };
  for (const double loud : {40.0, 80.0}) {
    auto rule = this->with_contraction(1.0 / (1 << 12));
    (void)rule(of_both(loud), 1);
    EXPECT_FALSE(rule.sure);
    EXPECT_EQ(rule(of_both(0.2), 2), TypeParam::Answer::done);
    EXPECT_TRUE(rule.settled);
    EXPECT_EQ(rule.sure, loud < 64) << loud;
    rule.begin(0);
    (void)this->show(rule, 0.2, 1);
    EXPECT_FALSE(rule.sure) << "of the step before";
  }
}

TYPED_TEST(ContractionRule, LeavesMoreThanThatToRefinement) {
  auto rule = this->with_contraction(1.0 / (1 << 4));
  EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::done);
  EXPECT_FALSE(rule.settled);
}

// The last increment is left to Refinement where rounding is seen through the contraction, or where
// that is not known.
TYPED_TEST(ContractionRule, MakesTheLastIncrementWhereItContractsMuch) {
  for (const auto& [contraction, moves] : {std::pair(0x1p-7, true), std::pair(0x1p-6, false)}) {
    auto rule = this->with_contraction(contraction);
    EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::done);
    EXPECT_FALSE(rule.settled);
    EXPECT_EQ(rule.moves(), moves) << contraction;
  }
  typename TestFixture::Rule unknown;
  unknown.begin(0);
  EXPECT_FALSE(unknown.moves());
  // None at all settles it, whatever the contraction.
  auto rule = this->with_contraction(0.5);
  EXPECT_EQ(this->show(rule, 0, 1), TypeParam::Answer::done);
  EXPECT_TRUE(rule.settled);
  EXPECT_TRUE(rule.moves());
}

// One increment more settles it: 2^-9 cubed, 16 units, 2^20.
TYPED_TEST(ContractionRule, GoesOnWhereTheNextIncrementSettlesIt) {
  auto rule = this->with_contraction(1.0 / (1 << 9));
  EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::go_on);
  EXPECT_EQ(this->show(rule, 0.25, 2), TypeParam::Answer::done);
  EXPECT_TRUE(rule.settled);
}

TYPED_TEST(ContractionRule, KnowsNothingBeforeTheSecondIncrement) {
  typename TestFixture::Rule rule;
  rule.begin(0);
  EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::go_on);
  EXPECT_EQ(this->show(rule, 0.25, 2), TypeParam::Answer::done);
  EXPECT_FALSE(rule.settled);
}

TYPED_TEST(ContractionRule, LooksAgainAfter32Steps) {
  auto rule = this->with_contraction(1.0 / (1 << 14));
  rule.unchecked = 31;
  EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::done);
  EXPECT_TRUE(rule.settled);
  rule.unchecked = 32;
  rule.begin(0);
  EXPECT_NE(this->show(rule, 16, 1), TypeParam::Answer::failed);
  EXPECT_FALSE(rule.settled);
}

// A matrix of the work 4 is worth it where 4 rounds leave more than the fourth root of a unit of
// rounding: in double from 2^-13/4 on.
TYPED_TEST(ContractionRule, GivesUpWhereTheMatrixIsCheaper) {
  const double most = std::pow(static_cast<double>(TypeParam::unit), 1.0 / 16);
  EXPECT_FALSE(this->with_contraction(0.99 * most, 4).is_slow());
  EXPECT_TRUE(this->with_contraction(1.01 * most, 4).is_slow());
  EXPECT_TRUE(this->with_contraction(0.51, 13).is_slow());
  EXPECT_FALSE(this->with_contraction(0.9, 0).is_slow());
  auto rule = this->with_contraction(0.4, 4);
  EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::failed);
  rule.begin(4);
  EXPECT_FALSE(rule.is_slow());  // it is tried again
  // And where Refinement has found it.
  rule = this->with_contraction(0.4, 4);
  EXPECT_TRUE(rule.gives_up());
  EXPECT_FALSE(rule.gives_up());
}

// Increments that grow from next to rounding on end in no solution.
TYPED_TEST(ContractionRule, TakesNoDivergenceForTheEnd) {
  typename TestFixture::Rule rule;
  rule.begin(13);
  double units = 3;
  int iteration = 1;
  for (; iteration < 20; ++iteration, units *= 3) {
    const auto verdict = this->show(rule, units, iteration);
    ASSERT_NE(verdict, TypeParam::Answer::done) << iteration;
    if (verdict == TypeParam::Answer::failed) break;
  }
  EXPECT_LT(iteration, 8);
}

// A state of equilibrium has no increments, and no two that tell a contraction.
TYPED_TEST(ContractionRule, EndsWhereNothingMoves) {
  for (const int work : {0, 4}) {
    for (const double length : {0.0, 1.0}) {
      typename TestFixture::Rule rule;
      rule.begin(work);
      typename TypeParam::Moved distance;
      distance.add(typename TestFixture::Number(0), typename TestFixture::Number(length));
      EXPECT_EQ(rule(distance, 1), TypeParam::Answer::done);
    }
  }
}

// However often it is asked for one more.
TYPED_TEST(ContractionRule, AlwaysComesToAnEnd) {
  for (const double units : {0.5, 9.0, 63.0, 65.0, 5000.0}) {
    typename TestFixture::Rule rule;
    rule.begin(4);
    int iteration = 1;
    while (iteration <= 500 && this->show(rule, units, iteration) == TypeParam::Answer::go_on) {
      ++iteration;
    }
    EXPECT_LE(iteration, 500) << units;
  }
}

// Where q waits for p and p for q: increments fall by a 4th and a 2^16th in turn, in this order or
// in the other one, and two of them by a 2^18th.
TYPED_TEST(ContractionRule, OfTwoIncrementsIsTheSameInEitherOrder) {
  for (const int first : {2, 16}) {
    typename TestFixture::RuleOfTwo rule;
    rule.begin(0);
    double units = 0x1p44;
    for (int iteration = 1; iteration <= 4; ++iteration) {
      EXPECT_EQ(this->show(rule, units, iteration), TypeParam::Answer::go_on);
      EXPECT_EQ(double(rule.contraction) < 1, iteration > 2);
      if (iteration > 2) {
        EXPECT_EQ(double(rule.contraction), 0x1p-18);
      }
      units = std::ldexp(units, iteration % 2 == 1 ? -first : first - 18);
    }
  }
}

// The next increment but one is what the slopes are off by: 2^-24, 16 units and 2^20 are a unit.
TYPED_TEST(ContractionRule, OfTwoIncrementsSettlesWhatIsLost) {
  using Rule = typename TestFixture::RuleOfTwo;
  auto rule = this->template with_contraction<Rule>(0x1p-24);
  EXPECT_EQ(this->show(rule, 15, 1), TypeParam::Answer::done);
  EXPECT_TRUE(rule.settled);
  rule = this->template with_contraction<Rule>(0x1p-23);
  EXPECT_EQ(this->show(rule, 15, 1), TypeParam::Answer::go_on);  // to a 64th of 15 units
  EXPECT_EQ(this->show(rule, 10, 2), TypeParam::Answer::go_on);  // to 2^-23 times 15
  EXPECT_FALSE(rule.settled);
  rule = this->template with_contraction<Rule>(0x1p-23);
  EXPECT_EQ(this->show(rule, 15, 1), TypeParam::Answer::go_on);
  EXPECT_EQ(this->show(rule, 1, 2), TypeParam::Answer::done);
  EXPECT_TRUE(rule.settled);
}

TYPED_TEST(ContractionRule, OfTwoIncrementsKnowsNothingBeforeTheThird) {
  typename TestFixture::RuleOfTwo rule;
  rule.begin(0);
  EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::go_on);
  EXPECT_EQ(this->show(rule, 0.25, 2), TypeParam::Answer::go_on);
  EXPECT_EQ(this->show(rule, 0.01, 3), TypeParam::Answer::done);
  EXPECT_FALSE(rule.settled);
}

// Three rounds of Refinement tell it, whatever the second one says; where the third is too small to
// be seen it is what the second one did, twice, and no more than can be hidden.
TYPED_TEST(ContractionRule, OfTwoIncrementsIsThatOfTwoRounds) {
  const auto learnt = [](double one, double two) {
    typename TestFixture::RuleOfTwo rule;
    rule.begin(0);
    EXPECT_EQ(rule.rounds_asked(), 2);
    rule.learn_of_rounds(1, one, 0x1p-14);
    EXPECT_EQ(rule.rounds_asked(), 2);
    rule.learn_of_rounds(2, two, 0x1p-14);
    EXPECT_EQ(rule.rounds_asked(), 0);
    return double(rule.contraction);
  };
  EXPECT_EQ(learnt(0.5, 0x1p-9), 0x1p-9);
  EXPECT_EQ(learnt(0x1p-12, 0x1p-9), 0x1p-9);
  EXPECT_EQ(learnt(0x1p-12, 0x1p-15), 0x1p-24);
  EXPECT_EQ(learnt(0.5, 0x1p-15), 0x1p-14);
  EXPECT_EQ(this->with_contraction(0.5).rounds_asked(), 0);
}

// A step that checks is asked for them: x = A x with the contraction 2^-6 of two increments, of
// which one is a half.
TYPED_TEST(ContractionRule, OfTwoIncrementsLearnsFromThreeRounds) {
  using Real = typename TypeParam::Scalar;
  auto rule = this->template with_contraction<typename TestFixture::RuleOfTwo>(1e-3);
  rule.unchecked = 32;
  EXPECT_EQ(this->show(rule, 4, 1), TypeParam::Answer::done);
  typename TypeParam::template Refined<2, 2> refinement;
  Real point[2] = {1 + TypeParam::unit, 1 + TypeParam::unit};
  int evaluations = 0;
  for (bool more = true; more; ++evaluations) {
    const Real x = point[0] - 1;
    const Real y = point[1] - 1;
    const Real lack[2] = {y / 2 - x, x / 32 - y};
    const Real slope[2] = {0, 0};
    more = refinement(rule, point, lack, slope);
  }
  EXPECT_GE(evaluations, 3);
  // In float that cannot be seen.
  const bool is_float = double(TypeParam::unit) > 1e-10;
  EXPECT_NEAR(double(rule.contraction), is_float ? 1.0 / 16 : 1.0 / 64, 1e-3);
}

// A small increment between two that are not tells nothing of how slow it is.
TYPED_TEST(ContractionRule, OfTwoIncrementsGivesUpWhereTheMatrixIsCheaper) {
  using Rule = typename TestFixture::RuleOfTwo;
  const double most = std::pow(static_cast<double>(TypeParam::unit), 1.0 / 8);
  EXPECT_FALSE(this->template with_contraction<Rule>(0.99 * most, 4).is_slow());
  EXPECT_TRUE(this->template with_contraction<Rule>(1.01 * most, 4).is_slow());
  EXPECT_TRUE(this->template with_contraction<Rule>(0.51, 26).is_slow());
  for (const double third : {0.2, 0.6}) {
    Rule rule;
    rule.begin(26);
    EXPECT_EQ(this->show(rule, 1e6, 1), TypeParam::Answer::go_on);
    EXPECT_EQ(this->show(rule, 1e4, 2), TypeParam::Answer::go_on);
    const auto verdict = this->show(rule, 1e6 * third, 3);
    EXPECT_EQ(verdict == TypeParam::Answer::failed, third > 0.5);
  }
}

// 128^-2: two times what is between 1/96 and less.
TYPED_TEST(ContractionRule, OfTwoIncrementsMakesTheLastWhereEachContractsMuch) {
  using Rule = typename TestFixture::RuleOfTwo;
  EXPECT_TRUE(this->template with_contraction<Rule>(0x1p-14).moves());
  EXPECT_FALSE(this->template with_contraction<Rule>(0x1p-13).moves());
}

// x = 1/8 x + b, from a point one unit away: what the rule has settled is taken as it is, else the
// change of the slope is found, and the contraction too.
TYPED_TEST(ContractionRule, LearnsFromRefinement) {
  using Real = typename TypeParam::Scalar;
  const Real solution = 1;
  for (const bool settled : {true, false}) {
    auto rule = this->with_contraction(1.0 / (1 << 14));
    EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::done);
    rule.settled = settled;
    rule.sure = true;
    typename TypeParam::template Refined<1, 2> refinement;
    Real point[1] = {solution + TypeParam::unit};
    const Real rounded = point[0];
    int evaluations = 0;
    for (bool more = true; more; ++evaluations) {
      const Real slope[2] = {point[0] / 8, 0};
      const Real lack[1] = {(solution - point[0]) * Real(7) / 8};
      more = refinement(rule, point, lack, slope);
    }
    EXPECT_EQ(point[0], rounded);
    EXPECT_EQ(evaluations == 1, settled);
    const double change = double(refinement.change[0] / TypeParam::unit);
    EXPECT_NEAR(change, settled ? 0 : -1.0 / 8, 1e-3);
    EXPECT_NEAR(double(rule.contraction), settled ? 1.0 / (1 << 14) : 1.0 / 8, 1e-3);
  }
}

// A contraction that was learnt long ago may be wrong: what the equations lack says so.
TYPED_TEST(ContractionRule, IsNotBelievedAgainstWhatIsSeen) {
  using Real = typename TypeParam::Scalar;
  auto rule = this->with_contraction(1.0 / (1 << 14));
  EXPECT_EQ(this->show(rule, 16, 1), TypeParam::Answer::done);
  typename TypeParam::template Refined<1, 2> refinement;
  Real point[1] = {1};
  const Real slope[2] = {0, 0};
  const Real lack[1] = {8 * TypeParam::unit};
  EXPECT_TRUE(refinement(rule, point, lack, slope));
  EXPECT_FALSE(rule.settled);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
