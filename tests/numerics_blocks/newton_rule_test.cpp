// When Newton's iteration stops: what it may believe after one increment, and what not.
#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class NewtonRule : public ::testing::Test {
 protected:
  using Number = typename Blocks::Scalar;
  using Answer = typename Blocks::Answer;

  // Increments of solutions of size 1 that are lost in rounding once squared, with 2^-20 to spare:
  // round-off is 2^(1 - bits).
  static Number small() { return Blocks::two_to(-(Blocks::bits + 21) / 2); }

  // A rule that has seen increments s, s^2 * contraction in its first step.
  template <int Power>
  static typename Blocks::template Newton<Power> taught(Number contraction) {
    typename Blocks::template Newton<Power> rule;
    const Number first = Blocks::two_to(-4);
    rule.begin(false);
    EXPECT_EQ(rule(first, Number(1), 1), Answer::go_on);
    rule(contraction * (Power == 2 ? first * first : first), Number(1), 2);
    // Straight: any increment may stand.
    rule.motion.move = Blocks::two_to(-4);
    rule.motion.bend = 0;
    return rule;
  }
  // The answer to the first increment of a step.
  template <class Rule>
  static Answer step(Rule& rule, Number size) {
    rule.begin(false);
    return rule(size, Number(1), 1);
  }
};
TYPED_TEST_SUITE(NewtonRule, EveryScalar);

// From nothing: increments 2^-2, 2^-4, 2^-8, ...  It may stop when the next one is 2^-20 of a
// rounding, not before.
TYPED_TEST(NewtonRule, QuadraticConvergenceIsFollowedToRounding) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::template Newton<2> rule;
  rule.begin(false);
  Real size = TypeParam::two_to(-2);
  Verdict verdict = Verdict::go_on;
  for (int iteration = 1; verdict == Verdict::go_on; ++iteration) {
    verdict = rule(size, Real(1), iteration);
    size = size * size;
  }
  EXPECT_EQ(verdict, Verdict::done);
  EXPECT_TRUE(size <= TypeParam::unit * TypeParam::two_to(-20));
}

TYPED_TEST(NewtonRule, ASlowLinearContractionIsNotTakenForAQuadraticOne) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::template Newton<1> rule;
  rule.begin(false);
  Real size = TypeParam::two_to(-4);
  Verdict verdict = Verdict::go_on;
  for (int iteration = 1; verdict == Verdict::go_on; ++iteration) {
    verdict = rule(size, Real(1), iteration);
    size = size / 8;
  }
  EXPECT_EQ(verdict, Verdict::done);
  EXPECT_TRUE(size <= TypeParam::unit);
}

// What an approximate matrix leaves of an increment below rounding is no chance: where it is more
// than 2^-13 roundings another increment follows, which is the last.
TYPED_TEST(NewtonRule, AnApproximateMatrixWantsAnIncrementOfRoundingAlone) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const Real below = TypeParam::unit / 2;
  auto coarse = this->template taught<1>(TypeParam::two_to(-5));
  EXPECT_EQ(this->step(coarse, below), Verdict::go_on);
  EXPECT_EQ(coarse(below, Real(1), 2), Verdict::done);
  auto fine = this->template taught<1>(TypeParam::two_to(-13));
  EXPECT_EQ(this->step(fine, below), Verdict::done);
  auto exact = this->template taught<2>(TypeParam::two_to(-5));
  EXPECT_EQ(this->step(exact, below), Verdict::done);
}

TYPED_TEST(NewtonRule, OneIncrementIsEnoughWhereTheMotionIsStraight) {
  using Verdict = typename TypeParam::Answer;
  auto rule = this->template taught<2>(1);
  EXPECT_EQ(this->step(rule, this->small()), Verdict::done);
  EXPECT_EQ(this->step(rule, 4 * this->small()), Verdict::go_on);  // measured: not small enough
}

// The wall: what was measured has become false, but the motion bends.
TYPED_TEST(NewtonRule, OneIncrementIsNotEnoughWhereTheMotionBends) {
  using Verdict = typename TypeParam::Answer;
  using Real = typename TypeParam::Scalar;
  auto rule = this->template taught<2>(TypeParam::two_to(-30));
  const Real size = TypeParam::unit * 4;  // next to rounding, and yet
  rule.motion.move = size * 2;
  rule.motion.bend = TypeParam::unit;
  EXPECT_EQ(this->step(rule, size), Verdict::go_on);
  auto linear = this->template taught<1>(TypeParam::two_to(-30));
  linear.motion = rule.motion;
  linear.motion.move = size * 512;
  linear.motion.bend = TypeParam::unit;
  EXPECT_EQ(this->step(linear, size), Verdict::go_on);
}

// 2^20 times what the motion shows must be lost in rounding, no more and no less.
TYPED_TEST(NewtonRule, TheMotionIsTakenAMillionTimes) {
  using Verdict = typename TypeParam::Answer;
  using Scalar = typename TypeParam::Scalar;
  auto rule = this->template taught<2>(TypeParam::two_to(-30));
  const auto size = TypeParam::unit * 2;
  rule.motion.move = size;
  rule.motion.bend = TypeParam::unit / 1048576;
  // Here the increment itself is the larger bend.
  EXPECT_EQ(this->step(rule, size), Verdict::go_on);
  // An increment whose square is a 2^-21th of a unit, a step of a 2^-8th: 2^-15 may bend.
  const auto small = this->small();
  rule.motion.move = TypeParam::two_to(-8);
  rule.motion.bend = TypeParam::two_to(-15) * Scalar(0.99);
  EXPECT_EQ(this->step(rule, small), Verdict::done);
  rule.motion.bend = TypeParam::two_to(-12);
  EXPECT_EQ(this->step(rule, small), Verdict::go_on);
}

// Of an unknown that hardly moves it must be lost 2^20 times in 2^10 times its way: its momentum is
// rounded as that.
TYPED_TEST(NewtonRule, OfWhatHardlyMovesTheWayCounts) {
  using Verdict = typename TypeParam::Answer;
  using Scalar = typename TypeParam::Scalar;
  auto rule = this->template taught<2>(TypeParam::two_to(-30));
  const auto small = this->small();
  const auto move = TypeParam::two_to(-11);  // 2^-1, 2^10 times
  const auto most = move * move / TypeParam::two_to(-1) * TypeParam::two_to(-1);
  rule.motion.move = move;
  rule.motion.bend = most * Scalar(0.99);
  EXPECT_EQ(this->step(rule, small), Verdict::done);
  rule.motion.bend = most * 8;
  EXPECT_EQ(this->step(rule, small), Verdict::go_on);
}

TYPED_TEST(NewtonRule, NothingIsBelievedWithoutAMotion) {
  using Verdict = typename TypeParam::Answer;
  auto rule = this->template taught<2>(TypeParam::two_to(-30));
  rule.motion = {};
  EXPECT_EQ(this->step(rule, 2 * TypeParam::unit), Verdict::go_on);
  EXPECT_EQ(this->step(rule, TypeParam::unit), Verdict::done);  // nothing is left to believe
}

TYPED_TEST(NewtonRule, EvenThenEvery32ndStepIsChecked) {
  using Verdict = typename TypeParam::Answer;
  auto rule = this->template taught<2>(1);
  int alone = 0;
  while (this->step(rule, this->small()) == Verdict::done && alone < 100) ++alone;
  EXPECT_EQ(alone, 31);
  // A second increment as foretold, and it goes on as before.
  EXPECT_EQ(rule(TypeParam::unit / 2, typename TypeParam::Scalar(1), 2), Verdict::done);
  EXPECT_EQ(this->step(rule, this->small()), Verdict::done);
}

// What a check sees above the noise counts at once, what it sees below it slowly.
TYPED_TEST(NewtonRule, TheContractionRisesAtOnceAndFallsSlowly) {
  using Real = typename TypeParam::Scalar;
  auto rule = this->template taught<2>(1);
  const Real first = TypeParam::two_to(-4);
  rule.begin(false);
  (void)rule(first, Real(1), 1);
  (void)rule(16 * first * first, Real(1), 2);
  EXPECT_TRUE(rule.contraction == 16);
  rule.begin(false);
  (void)rule(first, Real(1), 1);
  (void)rule(first * first / 16, Real(1), 2);
  EXPECT_TRUE(rule.contraction == 4);
}

// Rounding errors have no quadratic convergence: they end it where they are small.
TYPED_TEST(NewtonRule, NoiseIsTheEndIfItIsSmall) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  for (const double units : {100.0, 4000.0, 5000.0}) {
    typename TypeParam::template Newton<2> rule;
    rule.begin(false);
    int iteration = 1;
    Verdict verdict = Verdict::go_on;
    while (verdict == Verdict::go_on) {
      verdict = rule(Real(units) * TypeParam::unit, Real(1), iteration++);
    }
    EXPECT_EQ(verdict, units < 4096 ? Verdict::done : Verdict::failed) << units;
    EXPECT_EQ(iteration - 1, units < 4096 ? 3 : 60) << units;
  }
}

// From the state it may wander and still arrive; a prediction that does is left, unless it is the
// noise of rounding that does not halve.
TYPED_TEST(NewtonRule, APredictionIsFollowedWhileIncrementsHalve) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  for (const bool predicted : {false, true}) {
    typename TypeParam::template Newton<2> rule;
    rule.begin(predicted);
    EXPECT_EQ(rule(TypeParam::two_to(-2), Real(1), 1), Verdict::go_on);
    EXPECT_EQ(rule(TypeParam::two_to(-3), Real(1), 2), Verdict::go_on);
    EXPECT_EQ(rule(TypeParam::two_to(-3), Real(1), 3),
              predicted ? Verdict::failed : Verdict::go_on);
    rule.begin(predicted);
    EXPECT_EQ(rule(4096 * TypeParam::unit, Real(1), 1), Verdict::go_on);
    EXPECT_EQ(rule(4096 * TypeParam::unit, Real(1), 2), Verdict::go_on);
    EXPECT_EQ(rule(4096 * TypeParam::unit, Real(1), 3), Verdict::done);
  }
}

TYPED_TEST(NewtonRule, AnInfiniteIncrementIsAFailure) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const Real infinite = Real(__builtin_inf());
  auto rule = this->template taught<2>(1);
  EXPECT_EQ(this->step(rule, infinite), Verdict::failed);
  EXPECT_EQ(this->step(rule, infinite - infinite), Verdict::failed);
}

// x = k^4 has the first difference 4 k^3 - ... and the fourth 24; another unknown is not looked at.
TYPED_TEST(NewtonRule, TheMotionIsThatOfItsUnknowns) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template Past<3> past;
  typename TypeParam::template Newton<2> quadratic;
  typename TypeParam::template Newton<1> linear;
  const auto power = [](int k) { return Real(k * k * k * k); };
  for (int k = -6; k <= 6; ++k) {
    const Real x[3] = {Real(1000 * k), power(k), -power(k)};
    quadratic.watch(past, x, 1, 2);
    linear.watch(past, x, 1, 1);
    past.record(x);
  }
  EXPECT_TRUE(quadratic.motion.move == 2 * (power(6) - power(5)));
  EXPECT_TRUE(quadratic.motion.bend == 2 * 24);
  EXPECT_TRUE(linear.motion.move == power(6) - power(5));
  // The third difference: 24 k - 36 at k = 6.
  EXPECT_TRUE(linear.motion.bend == 108);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
