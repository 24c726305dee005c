// The rules of two solvers that share the stages of a Runge-Kutta method.
#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class StageRules : public ::testing::Test {
 protected:
  using Number = typename Blocks::Scalar;
  using Answer = typename Blocks::Answer;

  // One unknown 1 that moves by so many units of rounding.
  static typename Blocks::Moved moved(double units) {
    typename Blocks::Moved distance;
    distance.units = 64;  // in float, too
    distance.add(Number(units) * Blocks::unit, 1);
    return distance;
  }
};
TYPED_TEST_SUITE(StageRules, EveryScalar);

TYPED_TEST(StageRules, ASlowFixedPointGivesUpAfterThreeSlowIterations) {
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::Impatient rule;
  rule.begin();
  double units = 1e6;
  for (int iteration = 1; iteration <= 3; ++iteration, units *= 0.6) {
    EXPECT_EQ(rule(this->moved(units), iteration), Verdict::go_on) << iteration;
  }
  EXPECT_EQ(rule(this->moved(units), 4), Verdict::failed);
}

TYPED_TEST(StageRules, AFastOneGoesToItsEnd) {
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::Impatient rule;
  rule.begin();
  double units = 1e6;
  Verdict verdict = Verdict::go_on;
  int iteration = 0;
  for (; verdict == Verdict::go_on; units *= 0.4) verdict = rule(this->moved(units), ++iteration);
  EXPECT_EQ(verdict, Verdict::done);
  EXPECT_EQ(iteration, 12);  // 1e6 0.4^11 < 64 < 1e6 0.4^10
}

// What is not seen above rounding is not slow.
TYPED_TEST(StageRules, SlowNextToRoundingIsNotSlow) {
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::Impatient rule;
  rule.begin();
  for (int iteration = 1; iteration <= 4; ++iteration) {
    EXPECT_EQ(rule(this->moved(3000 - iteration), iteration), Verdict::go_on) << iteration;
  }
}

// One that stands still a thousand units from rounding is no solution where Newton can go on: q and
// p of a stiff spring in turn do so.
TYPED_TEST(StageRules, StandingStillFarFromRoundingIsAFailureAndNearItIsTheEnd) {
  using Verdict = typename TypeParam::Answer;
  for (const double units : {1000.0, 50.0}) {
    typename TypeParam::Impatient rule;
    rule.begin();
    Verdict verdict = Verdict::go_on;
    int iteration = 0;
    while (verdict == Verdict::go_on && iteration < 500)
      verdict = rule(this->moved(units), ++iteration);
    EXPECT_EQ(verdict, units > 64 ? Verdict::failed : Verdict::done) << units;
    EXPECT_LT(iteration, 8) << units;
  }
}

TYPED_TEST(StageRules, AnOldMatrixThatContractsSlowlyIsReplaced) {
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::Simplified rule;
  bool factorised = true;
  rule.begin(factorised);
  EXPECT_EQ(rule(this->moved(1e6), 0, factorised, 1), Verdict::go_on);
  EXPECT_TRUE(factorised);
  EXPECT_EQ(rule(this->moved(5e5), 0, factorised, 2), Verdict::go_on);
  EXPECT_FALSE(factorised);
  // A new one has two iterations to show itself.
  factorised = true;
  EXPECT_EQ(rule(this->moved(4e5), 0, factorised, 3), Verdict::go_on);
  EXPECT_TRUE(factorised);
}

TYPED_TEST(StageRules, AFastMatrixStays) {
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::Simplified rule;
  bool factorised = true;
  rule.begin(factorised);
  double units = 1e7;
  Verdict verdict = Verdict::go_on;
  int iteration = 0;
  for (; verdict == Verdict::go_on; units /= 5) {
    verdict = rule(this->moved(units), 0, factorised, ++iteration);
  }
  EXPECT_EQ(verdict, Verdict::done);
  EXPECT_TRUE(factorised);
}

// Where the Hessian is huge the increments are small, far from any solution.
TYPED_TEST(StageRules, ASmallIncrementOfEquationsThatDoNotHoldIsAFailure) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::Simplified rule;
  bool factorised = true;
  rule.begin(factorised);
  EXPECT_EQ(rule(this->moved(10), Real(0.5), factorised, 1), Verdict::failed);
  EXPECT_FALSE(factorised);
  rule.begin(true);
  factorised = true;
  EXPECT_EQ(rule(this->moved(10), Real(0.01), factorised, 1), Verdict::done);
  EXPECT_TRUE(factorised);
}

// Of a solution 1: a contraction of 4 units is seen in the first step, and then 2^-22 of it is
// lost.
TYPED_TEST(StageRules, LinearEquationsAreSolvedWhenWhatASolveLeavesIsLost) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const Real unit = TypeParam::unit;
  const Real part = Real(1) / (1 << 22);
  typename TypeParam::Linear rule;
  rule.begin();
  EXPECT_EQ(rule(Real(1) / 4, 1, 1, 1), Verdict::go_on);
  EXPECT_EQ(rule(unit, 1, 2, unit), Verdict::done);
  EXPECT_EQ(rule.contraction, 4 * unit);
  rule.begin();
  EXPECT_EQ(rule(part, 1, 1, part), Verdict::done);
  rule.begin();
  EXPECT_EQ(rule(2 * part + 64 * unit, 1, 1, part), Verdict::go_on);
  // Each unknown counts, and not all together alone.
  rule.begin();
  EXPECT_EQ(rule(part, 1, 1, Real(1) / 64), Verdict::done);
  rule.begin();
  EXPECT_EQ(rule(part, 1, 1, Real(1) / 32), Verdict::go_on);
}

// Where the condition of the matrix is 2^10 units increments fall by that.
TYPED_TEST(StageRules, LinearEquationsOfAnIllConditionedMatrixAreSolvedAgainAndAgain) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const Real contraction = Real(1) / 1024;
  typename TypeParam::Linear rule;
  for (int step = 0; step < 3; ++step) {
    rule.begin();
    Real size = 1;
    Verdict verdict = Verdict::go_on;
    for (int iteration = 1; verdict == Verdict::go_on; ++iteration, size *= contraction)
      verdict = rule(size, 1, iteration, size);
    EXPECT_EQ(verdict, Verdict::done);
    // The last one leaves a 2^-20th of a rounding error.
    EXPECT_LE(size, TypeParam::unit) << step;
    EXPECT_GE(rule.contraction, contraction);
  }
}

TYPED_TEST(StageRules, LinearEquationsAreLookedAtAgainAfter32Steps) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::Linear rule;
  const Real small = 2 * TypeParam::unit;
  rule.contraction = TypeParam::unit;
  int looked_at = 0;
  for (int step = 0; step < 64; ++step) {
    rule.begin();
    if (rule(small, 1, 1, small) == Verdict::done) continue;
    ++looked_at;
    EXPECT_EQ(rule(TypeParam::unit / 2, 1, 2, 0), Verdict::done);
  }
  EXPECT_EQ(looked_at, 2);
}

TYPED_TEST(StageRules, LinearEquationsWithoutASolutionAreAFailure) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::Linear rule;
  rule.begin();
  EXPECT_EQ(rule(Real(0), Real(0), 1, Real(0)), Verdict::done);
  for (int iteration = 1; iteration < 60; ++iteration)
    EXPECT_EQ(rule(Real(1), 1, iteration, 1), Verdict::go_on);
  EXPECT_EQ(rule(Real(1), 1, 60, 1), Verdict::failed);
  const Real infinity = Real(std::numeric_limits<double>::infinity());
  EXPECT_EQ(rule(infinity, infinity, 1, 0), Verdict::failed);
  EXPECT_EQ(rule(infinity - infinity, Real(1), 1, 0), Verdict::failed);
  EXPECT_EQ(rule.relative(Real(1), Real(4)), Real(1) / 4);
  EXPECT_EQ(rule.relative(Real(0), Real(0)), Real(0));
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
