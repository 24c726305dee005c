// When Newton's iteration of several unknowns stops: each is asked, in whatever units it is
// written.
#include "tests/numerics_blocks/rules_of_many.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class NewtonRuleOfMany : public RulesOfMany<Blocks> {};
TYPED_TEST_SUITE(NewtonRuleOfMany, EveryScalar);

// An unknown that is a 2^-20th of another: of an approximate matrix it is waited for as long as its
// increments become smaller and are more than 8 of its own roundings.
TYPED_TEST(NewtonRuleOfMany, AnApproximateMatrixWaitsForUnknownsThatAreSmall) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const Real length[2] = {1, TypeParam::two_to(-20)};
  const auto moved_by = [&](auto& rule, double units, int iteration) {
    const Real moved[2] = {TypeParam::unit / 4, Real(units) * TypeParam::unit * length[1]};
    return rule.of_each(moved, length, length, 2, iteration);
  };
  auto rule = this->template taught<1, 2>(TypeParam::two_to(-13));
  rule.begin(false);
  EXPECT_EQ(moved_by(rule, 7, 1), Verdict::done);
  rule.begin(false);
  EXPECT_EQ(moved_by(rule, 1000, 1), Verdict::go_on);
  EXPECT_EQ(moved_by(rule, 100, 2), Verdict::go_on);
  EXPECT_EQ(moved_by(rule, 9, 3), Verdict::go_on);
  EXPECT_EQ(moved_by(rule, 1, 4), Verdict::done);
  rule.begin(false);
  EXPECT_EQ(moved_by(rule, 1000, 1), Verdict::go_on);
  EXPECT_EQ(moved_by(rule, 999, 2), Verdict::done);  // no more is to be had
}

// Increments that are all that an unknown has moved: one may serve for their sum, and not for each.
TYPED_TEST(NewtonRuleOfMany, OneIncrementIsNotEnoughForAnUnknownThatIsAllIncrement) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const auto sums = [](auto& rule, Real size, Real uneven, int iteration) {
    const Real length = 1;
    return rule.of_sums(&length, &size, size, uneven, size, length, 1, iteration);
  };
  const Real size = this->small();
  for (const Real uneven : {Real(0), TypeParam::unit, Real(1)}) {
    auto rule = this->template taught<2, 2>(1);
    rule.begin(false);
    EXPECT_EQ(sums(rule, size, uneven, 1), uneven < 1 ? Verdict::done : Verdict::go_on);
  }
  // The same where the contraction is measured in this step; below rounding nothing is waited for.
  const Real first = TypeParam::two_to(-(TypeParam::bits + 21) / 4);
  for (const Real uneven : {Real(0), Real(1)}) {
    auto rule = this->template taught<2, 2>(1);
    rule.begin(false);
    EXPECT_EQ(sums(rule, first, uneven, 1), Verdict::go_on);
    const Real second = first * first * TypeParam::two_to(TypeParam::bits > 100 ? -16 : 0);
    EXPECT_EQ(sums(rule, second, uneven, 2), uneven < 1 ? Verdict::done : Verdict::go_on);
    if (uneven < 1) continue;
    EXPECT_EQ(sums(rule, TypeParam::unit / 2, uneven, 3), Verdict::done);
  }
  // What was measured may be nothing, if the motion bends.
  auto rule = this->template taught<2, 2>(TypeParam::unit);
  rule.motion.bend = TypeParam::two_to(-8);
  rule.begin(false);
  EXPECT_EQ(sums(rule, TypeParam::unit * 4, Real(0), 1), Verdict::done);
  rule.begin(false);
  EXPECT_EQ(sums(rule, TypeParam::unit * 4, Real(1), 1), Verdict::go_on);
}

// Of each is what their sums and their parts are, whichever of them is small.
TYPED_TEST(NewtonRuleOfMany, OfEachIsOfSumsAndParts) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  int done = 0;
  for (int small = 0; small < 3; ++small) {
    for (int power = 0; power < TypeParam::bits; ++power) {
      auto each = this->template taught<2, 3>(1);
      auto sums = this->template taught<2, 3>(1);
      each.begin(false);
      sums.begin(false);
      Real length[3] = {0.5, 0.25, 0.25};
      length[small] = TypeParam::two_to(-power);
      const Real moved[3] = {this->small() / 4, this->small() / 4, this->small() / 4};
      const Real size = moved[0] + moved[1] + moved[2];
      // One of them goes a small part of its length, or nearly none.
      Real way[3] = {length[0], length[1], length[2]};
      way[(small + 1) % 3] = power % 2 == 0 ? TypeParam::two_to(-power) : Real(0);
      Real uneven = 0;
      for (int j = 0; j < 3; ++j) uneven += each.relative(j, moved[j], length[j], way[j]);
      const Verdict verdict = each.of_each(moved, length, way, 3, 1);
      EXPECT_EQ(verdict, sums.of_sums(length, moved, size, uneven, size, Real(1), 3, 1))
          << small << " " << power;
      done += verdict == Verdict::done ? 1 : 0;
    }
  }
  EXPECT_GT(done, 3);
  EXPECT_LT(done, 3 * TypeParam::bits);
}

TYPED_TEST(NewtonRuleOfMany, NothingMovedIsNoShare) {
  using Real = typename TypeParam::Scalar;
  using Rule = typename TypeParam::template NewtonOfMany<2, 2>;
  const Rule rule;
  EXPECT_EQ(rule.relative(0, Real(0), Real(0), Real(0)), Real(0));
  EXPECT_EQ(rule.relative(0, Real(1), Real(4), Real(4)), Real(1) / 4);
}

// What hardly moves is moved by a momentum that is as small: its increment is a part of its way.
TYPED_TEST(NewtonRuleOfMany, OfWhatHardlyMovesTheWayCounts) {
  using Real = typename TypeParam::Scalar;
  using Exact = typename TypeParam::template NewtonOfMany<2, 2>;
  using Approximate = typename TypeParam::template NewtonOfMany<1, 2>;
  const Real way = TypeParam::two_to(-14);
  const Real moved = TypeParam::unit * 16;
  EXPECT_EQ(Exact::felt(Real(1), way), TypeParam::two_to(-10) + TypeParam::unit);
  EXPECT_EQ(Exact::felt(Real(1), Real(0)), TypeParam::unit);  // and not nothing
  EXPECT_EQ(Exact::felt(Real(1), Real(1) / 8), Real(1));      // and not more than its length
  EXPECT_EQ(Exact().relative(0, moved, Real(1), Real(0)), moved / TypeParam::unit);
  EXPECT_EQ(Approximate().relative(0, moved, Real(1), way), moved);
  EXPECT_EQ(Approximate().relative(0, TypeParam::unit * 7, Real(1), way), Real(0));

  // The same increments, of an unknown that goes all its length and of one that goes a part of it.
  using Verdict = typename TypeParam::Answer;
  const Real length[2] = {1, 1};
  const Real moves[2] = {this->small(), this->small()};
  const Real far[2] = {1, 1};
  const Real near[2] = {1, TypeParam::two_to(-24)};
  auto rule = this->template taught<2, 2>(1);
  rule.begin(false);
  EXPECT_EQ(rule.of_each(moves, length, far, 2, 1), Verdict::done);
  rule.begin(false);
  EXPECT_EQ(rule.of_each(moves, length, near, 2, 1), Verdict::go_on);
}

// Whatever is scaled by a power of two, the answers are the same, as far as increments cannot be
// noise: the sizes are taken anew from what the unknowns have come to.
TYPED_TEST(NewtonRuleOfMany, UnitsChangeNoAnswer) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  using Past = typename TypeParam::template Past<2>;
  typename TypeParam::template NewtonOfMany<2, 2> plain, scaled;
  Past past, scaled_past;
  const Real by = TypeParam::two_to(TypeParam::bits < 53 ? -3 : -10);
  Numbers chance;
  int ended[3] = {};
  for (int step = 0; step < 2000; ++step) {
    plain.begin(step > 0);
    scaled.begin(step > 0);
    Real solution[2], length[2], moved[2];
    for (int j = 0; j < 2; ++j) {
      solution[j] = static_cast<Real>(chance.next());
      length[j] = solution[j] < 0 ? -2 * solution[j] : 2 * solution[j];
      const auto part = static_cast<Real>(chance.next() * chance.next() / 64);
      moved[j] = length[j] * (part < 0 ? -part : part);
    }
    const auto contraction = static_cast<Real>(1 + chance.next());
    Verdict verdict = Verdict::go_on;
    const auto is_seen = [&] {
      return moved[0] > 4096 * TypeParam::unit * (length[0] + length[1]);
    };
    for (int iteration = 1; verdict == Verdict::go_on && is_seen(); ++iteration) {
      verdict = plain.of_each(moved, length, length, 2, iteration);
      const Real length_there[2] = {length[0], length[1] * by};
      const Real moved_there[2] = {moved[0], moved[1] * by};
      ASSERT_EQ(scaled.of_each(moved_there, length_there, length_there, 2, iteration), verdict)
          << step << " " << iteration;
      for (int j = 0; j < 2; ++j) moved[j] *= contraction * moved[j] / length[j];
    }
    ++ended[static_cast<int>(verdict)];
    const Real solution_there[2] = {solution[0], solution[1] * by};
    plain.watch(past, solution, 0, 2);
    scaled.watch(scaled_past, solution_there, 0, 2);
    past.record(solution);
    scaled_past.record(solution_there);
  }
  // Of float one increment is never enough before it may be noise.
  EXPECT_GT(ended[1], TypeParam::bits > 24 ? 20 : -1);
}

// 1e-12 of a first unknown is 1e-2 of one that is as small, and what is left is another 1e-4.
TYPED_TEST(NewtonRuleOfMany, AnIncrementIsAPartOfItsUnknown) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const Real small = TypeParam::two_to(-30);
  for (const bool is_small : {false, true}) {
    auto rule = this->template taught<2, 2>(1);
    const Real length[2] = {1, is_small ? small : Real(1)};
    if (is_small) rule.unit[1] = 1 / small;
    const Real moved[2] = {this->small() / 2, this->small() / 2};
    rule.begin(false);
    EXPECT_EQ(rule.of_each(moved, length, length, 2, 1), is_small ? Verdict::go_on : Verdict::done);
  }
}

// Sizes begin with a first iteration; in every 16th step what has come to be more than twice as
// large is its own size, and of what is less than a 2^-10th of it that is halved.  The contraction
// is measured where one has changed.
TYPED_TEST(NewtonRuleOfMany, SizesFollowTheUnknowns) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template NewtonOfMany<2, 3> rule;
  const Real nothing[3] = {0, 0, 0};
  rule.know(nothing, nothing, 3);
  EXPECT_EQ(rule.unit[0], Real(0));  // of nothing there is no size
  const Real length[3] = {-1, 0, 0};
  const Real moved[3] = {0, -Real(1) / 64, 0};
  rule.know(length, moved, 3);
  const Real least = Real(1.5) * TypeParam::two_to(-40);
  const auto near = [](Real x, Real y) { return x <= y && x * 1.001 >= y; };
  EXPECT_TRUE(near(rule.unit[0], 1));
  EXPECT_TRUE(near(rule.unit[1], 2));
  EXPECT_TRUE(near(rule.unit[2] * least, 1));
  rule.know(moved, length, 3);
  EXPECT_TRUE(near(rule.unit[1], 2));  // known once

  // One that is far beyond its unknown is no size of it: the iteration may have gone astray.
  typename TypeParam::template NewtonOfMany<2, 3> astray;
  const Real small[3] = {1, Real(1) / 1024, 1};
  const Real far[3] = {0, 1, 0};
  astray.know(small, far, 3);
  EXPECT_TRUE(near(astray.unit[1], Real(1024) / 33));

  typename TypeParam::template Past<3> past;
  for (Real& unit : rule.unit) unit = 1;
  rule.unchecked = 0;
  rule.fresh = 0;
  const Real as_before[3] = {2, -2, Real(1) / 1024};
  for (int step = 0; step < 64; ++step) rule.watch(past, as_before, 0, 3);
  for (const Real& unit : rule.unit) EXPECT_EQ(unit, Real(1));
  EXPECT_LT(rule.unchecked, 32);
  const Real grown[3] = {1, -4, 1};
  for (int step = 0; step < 15; ++step) rule.watch(past, grown, 0, 3);
  EXPECT_EQ(rule.unit[1], Real(1));
  rule.watch(past, grown, 0, 3);
  EXPECT_EQ(rule.unit[0], Real(1));
  EXPECT_EQ(rule.unit[1], Real(1) / 4);
  EXPECT_GE(rule.unchecked, 32);
  rule.unchecked = 0;
  const Real fallen[3] = {1, -4, -Real(1) / 1025};
  for (int step = 0; step < 16; ++step) rule.watch(past, fallen, 0, 3);
  EXPECT_EQ(rule.unit[2], Real(32));
  EXPECT_GE(rule.unchecked, 32);
  // Not of what is nothing, and not beyond a 2^-40th of the largest.
  const Real none[3] = {1, -4, 0};
  for (int step = 0; step < 320; ++step) rule.watch(past, none, 0, 3);
  EXPECT_EQ(rule.unit[2], Real(32));
  const Real tiny[3] = {1, -4, TypeParam::two_to(-100)};
  for (int step = 0; step < 32 * 100; ++step) rule.watch(past, tiny, 0, 3);
  EXPECT_EQ(rule.unit[2], TypeParam::two_to(40));
}

// The bend and the way of each are parts of its size, too.
TYPED_TEST(NewtonRuleOfMany, TheMotionIsSeenInTheSameUnits) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template NewtonOfMany<2, 2> rule;
  typename TypeParam::template Past<3> past;
  const Real before[3] = {7, 1, 1};
  past.record(before);
  rule.unit[0] = 1;
  rule.unit[1] = Real(1) / 4;
  const Real now[3] = {9, Real(1.25), 3};
  rule.watch(past, now, 1, 2);
  EXPECT_EQ(rule.motion.move, Real(3) / 4);  // 1.25 - 1 + (3 - 1) / 4
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
