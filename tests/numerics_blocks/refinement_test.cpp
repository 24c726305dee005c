// The end of a fixed point below the last place of its unknowns: how far it goes, and in how many
// rounds.
#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class Refinement : public ::testing::Test {
 protected:
  using Number = typename Blocks::Scalar;
  using Refined = typename Blocks::template Refined<1, 1>;

  // Of x -> s + ratio (x - s) from the rounded 1 (or 0), s a 3rd of a unit of 1 above: the rounds
  // it takes; what the gradient x - 1 (or x) is off by at the end, in units, is left in `error`.
  template <class OfOne>
  static int rounds(OfOne& refinement, Number ratio, Number& error, Number from = 1) {
    const Number third = Blocks::unit / 3;
    Number point[1] = {from};
    int count = 0;
    for (bool more = true; more; ++count) {
      const Number by = point[0] - from;
      const Number lack[1] = {(1 - ratio) * (third - by)};
      const Number slope[1] = {by};
      more = refinement(point, lack, slope);
    }
    EXPECT_EQ(point[0], from);
    EXPECT_TRUE(refinement.found);
    EXPECT_EQ(refinement.slope[0], Number(0));
    error = Blocks::absolute(refinement.change[0] - third) / Blocks::unit;
    return count;
  }
};
// Of float a difference over so short a way knows no more than a 100th of a unit.
using Finer = ::testing::Types<of_double::Blocks, of_long_double::Blocks, of_quad::Blocks>;
TYPED_TEST_SUITE(Refinement, Finer);

// What the last round leaves, the contraction times its increment, is a 2^-13th of a unit at most.
TYPED_TEST(Refinement, WhatIsLeftIsATinyPartOfAUnit) {
  using Real = typename TestFixture::Number;
  for (int bits = 1; bits <= 10; ++bits) {
    const Real ratio = TypeParam::two_to(-bits);
    typename TestFixture::Refined refinement;
    for (int use = 0; use < 3; ++use) {
      Real error = 0;
      (void)this->rounds(refinement, ratio, error);
      EXPECT_LE(static_cast<double>(ratio * error), 0x1p-13) << bits << " " << use;
    }
  }
}

// A round fewer where the contraction is known from the step before, or shown by two rounds.
TYPED_TEST(Refinement, TheContractionSparesARound) {
  using Real = typename TestFixture::Number;
  const auto taken = [&](auto& refinement, int bits) {
    Real error = 0;
    return this->rounds(refinement, TypeParam::two_to(-bits), error);
  };
  // From a third of a unit a factor of 2^-9 a round: 2^-1.6, 2^-10.6, which is less than a 1024th;
  // and 2^-19.6, if nothing is known.
  typename TestFixture::Refined fast;
  EXPECT_EQ(taken(fast, 9), 3);
  EXPECT_EQ(taken(fast, 9), 2);
  // Of 2^-4 two rounds have shown as much before the last but one.
  typename TestFixture::Refined slow;
  EXPECT_EQ(taken(slow, 4), 4);
  EXPECT_EQ(taken(slow, 4), 4);
}

// An unknown near zero that is rounded beside a 1 takes the rounds of one at 1; by itself it takes
// those that its own units are worth.
TYPED_TEST(Refinement, WhatIsRoundedBesideALengthEndsByItsUnits) {
  using Real = typename TestFixture::Number;
  for (const int bits : {1, 2, 4, 6}) {
    const Real ratio = TypeParam::two_to(-bits);
    typename TestFixture::Refined at_one;
    typename TestFixture::Refined alone;
    typename TypeParam::template Refined<1, 1, true> beside;
    beside.beside = 1;
    Real error = 0;
    const int expected = this->rounds(at_one, ratio, error);
    EXPECT_EQ(this->rounds(beside, ratio, error, 0), expected) << bits;
    EXPECT_LE(static_cast<double>(ratio * error), 0x1p-13) << bits;
    EXPECT_GT(this->rounds(alone, ratio, error, 0), expected) << bits;
  }
}

// Beside an unknown that is 2^20 times as large and contracts at once.
TYPED_TEST(Refinement, TheContractionIsThatOfPartsOfEachUnit) {
  using Real = typename TestFixture::Number;
  const Real third = TypeParam::unit / 3;
  const Real large = TypeParam::two_to(20);
  typename TypeParam::template Refined<2, 2> refinement;
  Real point[2] = {large, 1};
  for (bool more = true; more;) {
    const Real by[2] = {point[0] - large, point[1] - 1};
    const Real lack[2] = {large * third - by[0], (third - by[1]) * 7 / 8};
    more = refinement(point, lack, by);
  }
  EXPECT_LE(static_cast<double>(TypeParam::absolute(refinement.change[1] - third) / third), 0x1p-9);
}

// However fast it has been: what a slower round shows counts at once.
TYPED_TEST(Refinement, ASlowerContractionIsSeenAtOnce) {
  using Real = typename TestFixture::Number;
  typename TestFixture::Refined refinement;
  Real error = 0;
  for (int use = 0; use < 3; ++use) (void)this->rounds(refinement, TypeParam::two_to(-30), error);
  EXPECT_GT(this->rounds(refinement, Real(0.5), error), 10);
  EXPECT_LE(static_cast<double>(error), 0x1p-12);  // 2^-13 and half of it and half of that
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
