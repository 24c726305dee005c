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

// The errors of an increment are a part of it: below the root of a rounding error they are lost.
TYPED_TEST(StageRules, LinearEquationsAreSolvedWhenAnIncrementsErrorsAreLost) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const typename TypeParam::Linear rule;
  const Real part = rule.small_part;
  EXPECT_LE(part * part, TypeParam::unit);
  EXPECT_GT(4 * part * part, TypeParam::unit);
  EXPECT_EQ(rule(3 * part, Real(3), 1), Verdict::done);
  EXPECT_EQ(rule(4 * part, Real(3), 1), Verdict::go_on);
  EXPECT_EQ(rule(4 * part, Real(3), 59), Verdict::go_on);
  EXPECT_EQ(rule(4 * part, Real(3), 60), Verdict::failed);
  EXPECT_EQ(rule(Real(0), Real(0), 1), Verdict::done);
  const Real infinity = Real(std::numeric_limits<double>::infinity());
  EXPECT_EQ(rule(infinity, infinity, 1), Verdict::failed);
  EXPECT_EQ(rule(infinity - infinity, Real(1), 1), Verdict::failed);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
