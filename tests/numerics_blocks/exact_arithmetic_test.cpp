// Sums and products with what they lose, and what a fixed point lacks below the last place.
#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class ExactArithmetic : public ::testing::Test {};
TYPED_TEST_SUITE(ExactArithmetic, EveryScalar);

// The increment is on the grid of 1, the rest a sixteenth of it and below: on the way to 1 it would
// be lost at every step.
TYPED_TEST(ExactArithmetic, ARestBelowTheLastPlaceOfTheIncrementAddsUp) {
  using Real = typename TypeParam::Scalar;
  const Real unit = TypeParam::unit;
  Real value = 4;
  Real carry = 0;
  for (int i = 0; i < 1024; ++i) {
    const Real increment = i % 2 == 0 ? Real(1) : Real(-1);
    TypeParam::add_all(value, carry, increment, carry + unit / 16);
  }
  EXPECT_TRUE((value - 4) + carry == 64 * unit);
}

TYPED_TEST(ExactArithmetic, WhatSumsLoseIsCollected) {
  using Real = typename TypeParam::Scalar;
  const Real unit = TypeParam::unit;
  Real value = 1;
  Real lost = 0;
  for (int i = 0; i < 1024; ++i) TypeParam::collected(value, lost, unit / 16);
  EXPECT_TRUE(value == 1);
  EXPECT_TRUE(lost == 64 * unit);
}

// (1 + a u)(1 + b u) = 1 + (a + b) u + a b u^2 with u the unit: the last term is lost, and it is
// all.
TYPED_TEST(ExactArithmetic, AProductAndItsErrorAreExact) {
  using Real = typename TypeParam::Scalar;
  const Real unit = TypeParam::unit;
  for (int a = 1; a < 40; ++a) {
    for (int b = 1; b < 40; ++b) {
      const Real x = 1 + a * unit;
      const Real y = 1 + b * unit;
      EXPECT_TRUE(x * y == 1 + (a + b) * unit) << a << " " << b;
      EXPECT_TRUE(TypeParam::lost_of_product(x, y) == a * b * unit * unit) << a << " " << b;
    }
  }
}

// Numbers of few digits: no error.
TYPED_TEST(ExactArithmetic, AnExactProductHasNoError) {
  using Real = typename TypeParam::Scalar;
  Numbers numbers;
  for (int i = 0; i < 1000; ++i) {
    const Real x = Real(numbers.next());
    const Real y = Real(numbers.next());
    EXPECT_TRUE(TypeParam::lost_of_product(x, y) == 0);
  }
}

// 1 - x u/16 and x u/16 - 1, with u the unit: of numbers on the grid of u/2 below 1, so many
// sixteenths are lost, whichever is the larger one.
TYPED_TEST(ExactArithmetic, ADifferenceAndItsErrorAreExact) {
  using Real = typename TypeParam::Scalar;
  const Real sixteenth = TypeParam::unit / 16;
  for (int x = -40; x < 40; ++x) {
    const Real small = x * sixteenth;
    for (const Real sign : {Real(1), Real(-1)}) {
      const Real difference = sign - small;
      const Real lost = TypeParam::lost_of_difference(sign, small);
      EXPECT_TRUE((difference - sign) + lost == -small) << x;
      EXPECT_TRUE(lost == -((difference - sign) + small)) << x;
      EXPECT_TRUE(TypeParam::lost_of_difference(small, sign) == -lost) << x;
    }
  }
}

// Neighbours within a factor of two: no error.
TYPED_TEST(ExactArithmetic, ADifferenceThatCancelsHasNoError) {
  using Real = typename TypeParam::Scalar;
  const Real unit = TypeParam::unit;
  for (int i = 0; i < 1000; ++i) {
    const Real x = 1 + i * unit;
    const Real y = 1 + 31 * i * unit;
    EXPECT_TRUE(TypeParam::lost_of_difference(x, y) == 0) << i;
  }
}

// x = b + x/4 with a gradient g(x) = 3 x: at a point that is off by d = 3/8 units the equations
// lack (3/4) d, the solution is d away, and g lacks 3 d.
TYPED_TEST(ExactArithmetic, AFixedPointIsRefinedBelowItsLastPlace) {
  using Real = typename TypeParam::Scalar;
  const Real unit = TypeParam::unit;
  const Real d = 3 * unit / 8;
  typename TypeParam::template Refined<1, 1> refinement;
  for (int run = 0; run < 2; ++run) {  // it is as new after each
    Real point[1] = {1};
    for (bool more = true; more;) {
      // The solution is 1 + d.
      const Real distance = (point[0] - 1) - d;
      const Real lack[1] = {-(distance * 3 / 4)};
      const Real gradient[1] = {3 * (point[0] - 1)};
      more = refinement(point, lack, gradient);
    }
    EXPECT_TRUE(point[0] == 1);
    // The iteration contracts by 1/4 and ends with a change of 1/64.
    EXPECT_TRUE(TypeParam::absolute(refinement.change[0] - 3 * d) <= 3 * d / 32);
    EXPECT_TRUE(refinement.slope[0] == 0);
  }
}

// x = b + r x over 300 units, where the iteration before left off.
template <class Blocks>
typename Blocks::Scalar refined_over_300_units(typename Blocks::Scalar ratio, int& rounds) {
  using Real = typename Blocks::Scalar;
  const Real d = 300 * Blocks::unit;
  typename Blocks::template Refined<1, 1> refinement;
  Real point[1] = {1};
  rounds = 0;
  for (bool more = true; more; ++rounds) {
    const Real lack[1] = {-(((point[0] - 1) - d) * (1 - ratio))};
    const Real gradient[1] = {point[0] - 1};
    more = refinement(point, lack, gradient);
  }
  return refinement.change[0] / d;
}

// 31/32 a time: a hundred rounds and more, as it was left 32 times as far away as it moved last.
// It ends with an error of (1 + 300/128) 2^-13 units at most, so 31 times that are missing; a
// difference over a few units times the amplifier is wrong by a unit over the amplifier, 2^-7 of a
// float, and again 32 times that is missing.
TYPED_TEST(ExactArithmetic, ASlowContractionIsFollowedToItsEnd) {
  using Real = typename TypeParam::Scalar;
  int rounds = 0;
  const Real reached = refined_over_300_units<TypeParam>(Real(31) / 32, rounds);
  EXPECT_GT(rounds, 100);
  EXPECT_TRUE(TypeParam::absolute(reached - 1) <= Real(1) / 300) << double(reached);
}

// An unknown that is 0 at the point and this size in the solution, and contracts by 31/32 a time,
// beside the one above.
template <class Blocks>
int rounds_beside_one_of(typename Blocks::Scalar size) {
  using Real = typename Blocks::Scalar;
  const Real d = 3 * Blocks::unit / 8;
  typename Blocks::template Refined<2, 2> refinement;
  Real point[2] = {1, 0};
  int rounds = 0;
  for (bool more = true; more; ++rounds) {
    const Real lack[2] = {-(((point[0] - 1) - d) * 3 / 4), (size - point[1]) / 32};
    more = refinement(point, lack, point);
  }
  return rounds;
}

TYPED_TEST(ExactArithmetic, WhatIsLostBesideTheFirstRoundIsNotFollowed) {
  using Real = typename TypeParam::Scalar;
  const Real lost = TypeParam::unit * TypeParam::unit * TypeParam::unit;
  EXPECT_EQ(rounds_beside_one_of<TypeParam>(lost), rounds_beside_one_of<TypeParam>(0));
  EXPECT_GT(rounds_beside_one_of<TypeParam>(1024 * lost), 100);
}

TYPED_TEST(ExactArithmetic, WhatDoesNotContractIsNotFollowed) {
  int rounds = 0;
  (void)refined_over_300_units<TypeParam>(2, rounds);
  EXPECT_LE(rounds, 5);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
