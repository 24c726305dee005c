// Several unknowns of which one is quiet beside the others: it is asked by itself.
#include "tests/numerics_blocks/rules_of_many.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class QuietUnknowns : public RulesOfMany<Blocks> {};
TYPED_TEST_SUITE(QuietUnknowns, EveryScalar);

// What an unknown's own motion shows: an increment of it leaves bend (increment / move)^2 of its
// size, of which a 16th of its rounding may be left.  A louder neighbour hides nothing.
TYPED_TEST(QuietUnknowns, EachIsAskedWhatItsOwnMotionShows) {
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
  // 2^14 of the bend's parts by the square of the part of the way are one rounding of its length;
  // the first one is straight.
  const auto rule = watched(slow, bends);
  const Real seen = slow + bends;
  const Real square = TypeParam::unit * seen * seen / (16384 * bends);
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
TYPED_TEST(QuietUnknowns, EachIsAskedWhatItsOwnIncrementsHaveBecome) {
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

// In the first four steps the first increment is the motion, and promises nothing.
TYPED_TEST(QuietUnknowns, AFreshRuleIsToldNothingByItsFirstIncrement) {
  if (TypeParam::bits == 24) GTEST_SKIP() << "so small an increment is noise of float";
  using Real = typename TypeParam::Scalar;
  using Verdict = typename TypeParam::Answer;
  const Real length[2] = {1, 1};
  auto rule = this->template taught<2, 2>(TypeParam::unit);
  rule.fresh = 4;
  typename TypeParam::template Past<2> past;
  const Real small = TypeParam::two_to(-TypeParam::bits / 2);
  for (int step = 0; step < 6; ++step) {
    rule.begin(false);
    const Real first[2] = {TypeParam::two_to(-3), TypeParam::two_to(-3)};
    EXPECT_EQ(rule.of_each(first, length, length, 2, 1), Verdict::go_on);
    // The next one would be lost, were it told by the first.
    const Real told = small * TypeParam::two_to(TypeParam::bits > 100 ? -24 : -16);
    const Real second[2] = {told, told};
    EXPECT_EQ(rule.of_each(second, length, length, 2, 2), step < 4 ? Verdict::go_on : Verdict::done)
        << step;
    const Real solution[2] = {Real(step), Real(step)};
    rule.watch(past, solution, 0, 2);
    past.record(solution);
  }
}

// What does not become less beside what does: the step does not end with noise while one unknown
// converges.
TYPED_TEST(QuietUnknowns, NoiseEndsNothingWhileAnUnknownConverges) {
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
TYPED_TEST(QuietUnknowns, OfNoiseNoMoreIsToBeHad) {
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
