// When Newton's iteration of several unknowns stops: each is asked, in whatever units it is
// written.
#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class NewtonRuleOfMany : public ::testing::Test {
 protected:
  using Number = typename Blocks::Scalar;
  using Answer = typename Blocks::Answer;
  template <int Power, int Unknowns>
  using Rule = typename Blocks::template NewtonOfMany<Power, Unknowns>;

  // Increments of solutions of size 1 that are lost in rounding once squared, with 2^-20 to spare.
  static Number small() { return Blocks::two_to(-(Blocks::bits + 21) / 2); }

  // A rule of unknowns of size 1 that has seen increments s, s^2 * contraction in its first step.
  template <int Power, int Unknowns>
  static Rule<Power, Unknowns> taught(Number contraction) {
    Rule<Power, Unknowns> rule;
    for (Number& unit : rule.unit) unit = 1;
    const Number first = Blocks::two_to(-4);
    rule.begin(false);
    EXPECT_EQ(rule(first, Number(1), 1), Answer::go_on);
    rule(contraction * (Power == 2 ? first * first : first), Number(1), 2);
    // Straight: any increment may stand.
    rule.motion.move = Blocks::two_to(-4);
    rule.motion.least = rule.motion.move;
    rule.motion.bend = 0;
    for (Number& move : rule.moves) move = rule.motion.move;
    return rule;
  }
};
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
    return rule.of_sums(&size, &size, size, uneven, size, Real(1), 1, iteration);
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
    EXPECT_EQ(sums(rule, first * first, uneven, 2), uneven < 1 ? Verdict::done : Verdict::go_on);
    if (uneven < 1) continue;
    EXPECT_EQ(sums(rule, TypeParam::unit / 2, uneven, 3), Verdict::done);
  }
  // What was measured may be nothing, if the motion bends.
  auto rule = this->template taught<2, 2>(TypeParam::unit);
  rule.motion.bend = TypeParam::two_to(-4);
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

// What an unknown's own motion shows: an increment of it leaves bend (increment / move)^2 of its
// size, of which a 16th of its rounding may be left.  A louder neighbour hides nothing.
TYPED_TEST(NewtonRuleOfMany, EachIsAskedWhatItsOwnMotionShows) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const Real step = TypeParam::two_to(-4);
  // The first goes a 16th in a step; of the second the steps, or what they differ by, are small.
  const auto watched = [&](Real slow, Real bends) {
    auto rule = this->template taught<2, 2>(TypeParam::unit);
    typename TypeParam::template Past<2> past;
    Real solution[2] = {1, 1};
    for (int k = 0; k < 5; ++k) {
      solution[0] += step;
      solution[1] += slow;
      past.record(solution);
    }
    solution[0] += step;
    solution[1] += slow + bends;
    rule.watch(past, solution, 0, 2);
    return rule;
  };
  const Real length[2] = {1, 1};
  const auto moved_by = [&](auto rule, Real quiet) {
    const Real moved[2] = {0, quiet};
    rule.begin(true);
    return rule.of_each(moved, length, length, 2, 1);
  };
  const Real slow = TypeParam::two_to(-15);
  const Real bends = TypeParam::two_to(-12);
  const auto is_in_reach = [&](const auto& rule, Real quiet) {
    const Real moved[2] = {0, quiet};
    return rule.is_in_reach(moved, length, length, 2);
  };
  // 16 of the bend's parts by the square of the part of the way are one rounding of its length; the
  // first one is straight.
  const auto rule = watched(slow, bends);
  const Real seen = slow + bends;
  const Real square = TypeParam::unit * seen * seen / (16 * bends);
  Real least = 1;
  while (least * least > square) least /= 2;
  EXPECT_TRUE(is_in_reach(rule, least));
  EXPECT_FALSE(is_in_reach(rule, 2 * least));
  // The sums of both are straight enough for each of these.
  EXPECT_EQ(moved_by(rule, least), Verdict::done);
  EXPECT_EQ(moved_by(rule, 2 * least), Verdict::go_on);
  // No more than the noise of rounding bends nothing.
  const Real noise = TypeParam::unit * 512;
  EXPECT_TRUE(is_in_reach(watched(0, noise), noise));
  EXPECT_FALSE(is_in_reach(watched(0, 4 * noise), 4 * noise));
  // A force that has grown at once: the increment is more than the bend before it.
  EXPECT_FALSE(is_in_reach(watched(step, 0), step));
}

// Where increments were measured the next one of each is told by its own last two: a louder
// neighbour that is linear says nothing of it.
TYPED_TEST(NewtonRuleOfMany, EachIsAskedWhatItsOwnIncrementsHaveBecome) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const Real length[2] = {1, 1};
  const Real quarter = TypeParam::two_to(-TypeParam::bits / 4);
  // The second one is to be a third of the digits, its next two thirds: too much by itself.
  for (const bool slow : {false, true}) {
    auto rule = this->template taught<2, 2>(TypeParam::unit);
    rule.begin(false);
    const Real first[2] = {1, quarter};
    EXPECT_EQ(rule.of_each(first, length, length, 2, 1), Verdict::go_on);
    const Real second[2] = {0, slow ? quarter * quarter : quarter * quarter * quarter};
    const Verdict verdict = rule.of_each(second, length, length, 2, 2);
    EXPECT_EQ(verdict, slow ? Verdict::go_on : Verdict::done);
    if (!slow) continue;
    const Real third[2] = {0, quarter * quarter * quarter * quarter};
    EXPECT_EQ(rule.of_each(third, length, length, 2, 3), Verdict::done);
  }
  // Of what is as small as noise may be nothing is concluded.
  auto rule = this->template taught<2, 2>(TypeParam::unit);
  rule.begin(false);
  const Real noise[2] = {this->small(), 32 * TypeParam::unit};
  rule.motion.bend = TypeParam::two_to(20);
  EXPECT_EQ(rule.of_each(noise, length, length, 2, 1), Verdict::go_on);
  EXPECT_EQ(rule.relative(1, 32 * TypeParam::unit, Real(1), Real(1)), Real(0));
  EXPECT_EQ(rule.relative(1, 128 * TypeParam::unit, Real(1), Real(1)), 2048 * TypeParam::unit);
}

// What does not become less beside what does: the step does not end with noise while one unknown
// converges.
TYPED_TEST(NewtonRuleOfMany, NoiseEndsNothingWhileAnUnknownConverges) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  using Rule = typename TypeParam::template NewtonOfMany<2, 2>;
  const Real small = TypeParam::unit * TypeParam::two_to(-30);
  const Real length[2] = {1, small};
  for (const bool converges : {false, true}) {
    Rule rule;
    Real moved[2] = {128 * TypeParam::unit, small / 4};
    rule.begin(false);
    EXPECT_EQ(rule.of_each(moved, length, length, 2, 1), Verdict::go_on);
    for (int iteration = 2; iteration < 4; ++iteration) {
      if (converges) moved[1] /= 4;
      const bool ends = iteration == 3 && !converges;
      EXPECT_EQ(rule.of_each(moved, length, length, 2, iteration),
                ends ? Verdict::done : Verdict::go_on)
          << iteration;
    }
    if (!converges) continue;
    EXPECT_EQ(rule.of_each(moved, length, length, 2, 4), Verdict::done);
  }
}

// An unknown that is nothing but noise, next to others: where these are lost in rounding one more
// iteration shows that no more is to be had.
TYPED_TEST(NewtonRuleOfMany, OfNoiseNoMoreIsToBeHad) {
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  auto rule = this->template taught<2, 2>(1);
  const Real length[2] = {1, TypeParam::unit};
  const Real first[2] = {this->small() / 2, TypeParam::unit};
  const Real second[2] = {TypeParam::unit / 8, TypeParam::unit};
  rule.begin(false);
  EXPECT_EQ(rule.of_each(first, length, length, 2, 1), Verdict::go_on);
  EXPECT_EQ(rule.of_each(second, length, length, 2, 2), Verdict::done);
  // Where the first increment is nothing but that, too, a second one has to show it.
  rule.motion.bend = TypeParam::two_to(-2);
  rule.begin(false);
  EXPECT_EQ(rule.of_each(second, length, length, 2, 1), Verdict::go_on);
  EXPECT_EQ(rule.of_each(second, length, length, 2, 2), Verdict::done);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
