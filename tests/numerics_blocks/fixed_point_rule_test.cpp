// When an iteration stops that ends in nothing but rounding: never before, and never much after.
#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class FixedPointRule : public ::testing::Test {
 protected:
  using Number = typename Blocks::Scalar;
  using Answer = typename Blocks::Answer;

  // The iteration at which a rule stops that is shown these increments, in units of rounding of a
  // solution 1; 0 if it never does.  They are those of an unknown of this length, beside one that
  // stands still.
  template <int Cycle, class Increment>
  static int stop(const Increment& increment, Answer expected = Answer::done, double own = 0) {
    typename Blocks::template FixedPoint<Cycle> rule;
    for (int iteration = 1; iteration <= 1000; ++iteration) {
      typename Blocks::Moved distance;
      distance.add(Blocks::absolute(Number(increment(iteration)) * Blocks::unit), Number(own));
      distance.add(0, 1);
      const Answer verdict = rule(distance, iteration);
      if (verdict == Answer::go_on) continue;
      EXPECT_EQ(verdict, expected) << iteration;
      return iteration;
    }
    return 0;
  }
};
TYPED_TEST_SUITE(FixedPointRule, EveryScalar);

// After the first two iterations, which are the least ever of their kind, nothing decreases.
TYPED_TEST(FixedPointRule, TheLargerItIsTheLongerItMustStandStill) {
  const auto constant = [](double units) { return [units](int) { return units; }; };
  EXPECT_EQ(this->template stop<2>(constant(60)), 4);
  EXPECT_EQ(this->template stop<2>(constant(500)), 5);
  EXPECT_EQ(this->template stop<2>(constant(4000)), 6);
  EXPECT_EQ(this->template stop<1>(constant(60)), 3);
  EXPECT_EQ(this->template stop<1>(constant(500)), 4);
  EXPECT_EQ(this->template stop<1>(constant(4000)), 5);
}

TYPED_TEST(FixedPointRule, WhatStandsStillFarFromRoundingFails) {
  using Verdict = typename TypeParam::Answer;
  EXPECT_EQ(this->template stop<2>([](int) { return 5000.0; }, Verdict::failed), 500);
  EXPECT_EQ(this->template stop<1>([](int) { return 5000.0; }, Verdict::failed), 500);
}

// A prediction that leads astray: what grows a thousandfold is lost, but in the first four
// iterations, in which what is written in small units finds what is written in large ones.
TYPED_TEST(FixedPointRule, WhatGrowsAThousandfoldFails) {
  using Verdict = typename TypeParam::Answer;
  const auto grows = [](double by) {
    return [by](int i) {
      double size = 5000;
      for (int k = 4; k < i; ++k) size *= by;
      return i < 4 ? 5000.0 : size;
    };
  };
  EXPECT_EQ(this->template stop<2>(grows(2), Verdict::failed), 15);
  EXPECT_EQ(this->template stop<1>(grows(1025), Verdict::failed), 5);
  const auto finds = [](int i) { return i < 4 ? 1.0e5 : i == 4 ? 1.0e9 : 5000.0; };
  EXPECT_EQ(this->template stop<1>(finds, Verdict::failed), 500);
}

// The increments that one step ends with are far below those that the next one begins with.
TYPED_TEST(FixedPointRule, WhatWasReachedInAStepIsForgottenInTheNext) {
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::template FixedPoint<2> rule;
  for (int step = 0; step < 3; ++step) {
    rule.begin();
    Verdict verdict = Verdict::go_on;
    int iteration = 0;
    for (double units = 2000; verdict == Verdict::go_on; units = units > 1 ? units / 2 : 1) {
      typename TypeParam::Moved distance;
      distance.add(typename TestFixture::Number(units) * TypeParam::unit, 0);
      distance.add(0, 1);
      verdict = rule(distance, ++iteration);
    }
    EXPECT_EQ(verdict, Verdict::done);
    EXPECT_GT(iteration, 11) << step;  // 2000/2^11 is below 1
  }
}

// One iteration without progress is luck: 3000, 1500, 1500, 750, 750, ...
TYPED_TEST(FixedPointRule, OneStallIsNoEnd) {
  const auto halting = [](int i) { return 3000.0 / (1 << (i / 2)); };
  EXPECT_GT(this->template stop<1>(halting), 20);
}

// q far ahead of p: even iterations move by 10 units of rounding, odd ones are still on their way.
TYPED_TEST(FixedPointRule, EvenAndOddIterationsAreTwoSequences) {
  const auto two = [](int i) { return i % 2 == 0 ? 10.0 : 4000.0 / (1 << (i / 2)); };
  EXPECT_GT(this->template stop<2>(two), 16);
}

// What is left from there on is solved for otherwise, if no unknown moves by more than 2^14 units
// of its own rounding, or 2^2 in float.
TYPED_TEST(FixedPointRule, WhatIsNearItsEndIsThere) {
  const auto constant = [](double units) { return [units](int) { return units; }; };
  using Verdict = typename TypeParam::Answer;
  const bool is_float = static_cast<double>(TypeParam::unit) > 1e-10;
  EXPECT_EQ(this->template stop<2>(constant(60), Verdict::done, 1), is_float ? 4 : 1);
  const double most = is_float ? 4 : 16384;
  EXPECT_EQ(this->template stop<2>(constant(60), Verdict::done, 60 / (0.97 * most)), 1);
  EXPECT_EQ(this->template stop<2>(constant(60), Verdict::done, 60 / (1.03 * most)), 4);
  EXPECT_EQ(this->template stop<2>(constant(200), Verdict::done, 1), 5);
}

TYPED_TEST(FixedPointRule, InLoopsItIsNearNoFartherOffThan64Units) {
  typename TypeParam::Moved distance;
  distance.narrow();
  EXPECT_EQ(double(distance.units), static_cast<double>(TypeParam::unit) > 1e-10 ? 4 : 64);
}

// What would follow, by the last two: 400 units are an end if those before were 41 times as much,
// for 400 / 41 are less than 8 units of both, and a bit more is none.  In float no more than 4
// units are.
TYPED_TEST(FixedPointRule, WhatWouldMoveByNoMoreThanThatIsThere) {
  using Verdict = typename TypeParam::Answer;
  const bool is_float = static_cast<double>(TypeParam::unit) > 1e-10;
  const auto to = [](double units) {
    return [units](int i) { return i == 1 ? 16384.0 : i == 2 ? units : i == 3 ? 15.0 : 1.0; };
  };
  EXPECT_EQ(this->template stop<2>(to(400), Verdict::done, 0.25), is_float ? 4 : 2);
  EXPECT_EQ(this->template stop<2>(to(410), Verdict::done, 0.25), is_float ? 4 : 3);
  // Of an unknown of its own that is far more.
  EXPECT_EQ(this->template stop<2>(to(400), Verdict::done, 0.02), is_float ? 7 : 3);
  // One that grows has no end.
  const auto grows = [](int i) { return i == 1 ? 200.0 : i == 2 ? 300.0 : 1.0; };
  EXPECT_EQ(this->template stop<2>(grows, Verdict::done, 0.25), 3);
}

// The first increment of a step, by a 128th as the contraction of the step before; each 32nd time
// it is measured anew.
TYPED_TEST(FixedPointRule, AFirstIncrementIsToldByTheStepBefore) {
  using Verdict = typename TypeParam::Answer;
  typename TypeParam::template FixedPoint<2> rule;
  const auto moved = [](double units) {
    typename TypeParam::Moved distance;
    distance.add(typename TestFixture::Number(units) * TypeParam::unit, 1);
    return distance;
  };
  const auto taken = [&](double first) {
    rule.begin();
    if (rule(moved(first), 1) == Verdict::done) return 1;
    EXPECT_EQ(rule(moved(first / 128), 2), Verdict::done);
    return 2;
  };
  EXPECT_EQ(taken(250), 2);  // nothing is known
  if (static_cast<double>(TypeParam::unit) > 1e-10) {
    EXPECT_EQ(taken(250), 2);  // nor trusted over so many units of float
    EXPECT_EQ(taken(3), 1);
    return;
  }
  for (int step = 0; step < 32; ++step) EXPECT_EQ(taken(250), 1) << step;
  EXPECT_EQ(taken(250), 2);
  EXPECT_EQ(taken(250), 1);
  EXPECT_EQ(taken(260), 2);
}

// Ahead of a wave an unknown moves by more than all it was, and by nothing beside the others.
TYPED_TEST(FixedPointRule, WhatIsLostInTheWholeIsNotWaitedFor) {
  const auto unit = static_cast<double>(TypeParam::unit);
  const auto constant = [](double units) { return [units](int) { return units; }; };
  EXPECT_EQ(this->template stop<2>(constant(0.5 * unit * unit)), 1);
  EXPECT_GT(this->template stop<2>(constant(2.0 * unit * unit)), 1);
}

// 0.99 a time, and 500 times are not enough: what has become small is not what is missing.
TYPED_TEST(FixedPointRule, ASlowContractionIsNotTakenForItsLimit) {
  using Verdict = typename TypeParam::Answer;
  const auto slow = [](int i) {
    double units = 1e5;
    for (int k = 0; k < i; ++k) units *= 0.99;
    return units;
  };
  EXPECT_LT(slow(500), 4096);
  EXPECT_EQ(this->template stop<2>(slow, Verdict::failed), 500);
}

// The sign of an increment is none of its business.
TYPED_TEST(FixedPointRule, AnAlternatingIterationGoesToItsEnd) {
  const auto sign = [](int i) { return (i % 2 == 0 ? 1 : -1) * 4000.0 / (1 << (i < 20 ? i : 20)); };
  EXPECT_GT(this->template stop<1>(sign), 14);
}

TYPED_TEST(FixedPointRule, NoIncrementIsTheEndAndAnInfiniteOneAFailure) {
  using Verdict = typename TypeParam::Answer;
  EXPECT_EQ(this->template stop<2>([](int) { return 0.0; }), 1);
  const double infinite = __builtin_inf();
  EXPECT_EQ(this->template stop<2>([&](int) { return infinite; }, Verdict::failed), 1);
  EXPECT_EQ(this->template stop<2>([&](int) { return infinite - infinite; }, Verdict::failed), 1);
}

// x -> r x + (1 - r) from 0 in the scalar itself.  The last increment is 64 units or less, or the
// next one 16, and r/(1 - r) of it is the sum of all that would follow.  Rounding adds a unit or
// two of x and of the product, over the 1/(1 - |r|) iterations that remember it.
TYPED_TEST(FixedPointRule, ALinearContractionIsFollowedToWhereTheRestIsSolvedFor) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  for (const double ratio : {0.5, -0.5, 0.75, -0.75}) {
    typename TypeParam::template FixedPoint<2> rule;
    Real x = 0;
    Verdict verdict = Verdict::go_on;
    for (int iteration = 1; verdict == Verdict::go_on; ++iteration) {
      const Real next = Real(ratio) * x + Real(1 - ratio);
      typename TypeParam::Moved distance;
      distance.add(TypeParam::absolute(next - x), TypeParam::absolute(x));
      x = next;
      verdict = rule(distance, iteration);
    }
    EXPECT_EQ(verdict, Verdict::done) << ratio;
    const Real error = TypeParam::absolute(x - 1) / TypeParam::unit;
    const double r = ratio < 0 ? -ratio : ratio;
    EXPECT_LE(static_cast<double>(error), (64 * r + 2) / (1 - r)) << ratio;
  }
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
