// What stages in lanes have of their own: the distance of arrays and the refinement, bit for bit as
// one number after the other.
#include <gtest/gtest.h>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {

namespace stage_packs {
#include "generator/interpreter/lanes.inc"
#include "generator/numerics/lane_distance.hpp"
#include "generator/numerics/lane_refinement.hpp"
#include "generator/numerics/lane_stages.hpp"
}  // namespace stage_packs

namespace {

template <int W>
using Lanes = stage_packs::Pack<W>;

template <int W, int Count>
void expect_the_distance() {
  Numbers numbers;
  int ends = 0;
  for (int k = 0; k < 20; ++k) {
    double moved[Count];
    double value[Count];
    double beside[Count];
    for (int j = 0; j < Count; ++j) {
      value[j] = numbers.next();
      beside[j] = numbers.next();
      moved[j] = numbers.next() * (k % 2 == 0 ? 0x1p-50 : 1);
    }
    // One that is nothing beside the others.
    if (k % 4 == 0) {
      value[Count - 1] = beside[Count - 1] = 0;
      moved[Count - 1] = k % 8 == 0 ? 0x1p-160 : 0x1p-100;
    }
    of_double::Distance one;
    of_double::Distance all;
    one.add(moved, value, beside, Count);
    stage_packs::add_lanes(Lanes<W>(0), all, moved, value, beside, Count);
    EXPECT_EQ(one.size, all.size) << W << " of " << Count;
    EXPECT_EQ(one.scale, all.scale);
    EXPECT_EQ(one.near(), all.near());
    if (all.near()) ends += k % 8 == 0 ? 1 : 2;
  }
  EXPECT_EQ(ends % 2, 1);
}

TEST(StageLanes, HaveTheDistanceOfArrays) {
  expect_the_distance<2, 4>();
  expect_the_distance<2, 12>();
  expect_the_distance<4, 8>();
  expect_the_distance<4, 12>();
  expect_the_distance<8, 16>();
  expect_the_distance<8, 40>();
}

// Rounds of a refinement whose map contracts by a fifth, but slowly the last unknown, of this size
// in the solution: how many there are.
template <int W, int Size, bool RoundsBeside = false>
int expect_the_refinement(double last = 1, double beside = 0) {
  Numbers numbers;
  of_double::Refinement<Size, Size, RoundsBeside> one;
  stage_packs::RefinementInLanes<Lanes<W>, of_double::Refinement<Size, Size, RoundsBeside>> all;
  one.beside = all.beside = beside;
  int rounds = 0;
  for (int k = 0; k < 5; ++k) {
    double point[Size];
    double same[Size];
    for (int j = 0; j < Size; ++j) point[j] = same[j] = numbers.next();
    double end[Size];
    for (int j = 0; j < Size; ++j) end[j] = point[j] * (1 + numbers.next() * 0x1p-51);
    if (last < 1) point[Size - 1] = same[Size - 1] = 0;
    if (last < 1) end[Size - 1] = last;
    for (bool more = true; more; ++rounds) {
      double lack[Size];
      double gradient[Size];
      for (int j = 0; j < Size; ++j) {
        EXPECT_EQ(point[j], same[j]);
        lack[j] = end[j] - point[j] + (point[(j + 1) % Size] - end[(j + 1) % Size]) / 5;
        gradient[j] = 3 * point[j];
      }
      if (last < 1) lack[Size - 1] = (last - point[Size - 1]) / 32;
      more = one(point, lack, gradient);
      EXPECT_EQ(all(same, lack, gradient), more);
      if (::testing::Test::HasFailure()) return 0;
      EXPECT_EQ(one.last, all.last);
    }
    for (int j = 0; j < Size; ++j) {
      EXPECT_EQ(one.change[j], all.change[j]);
      EXPECT_EQ(one.slope[j], all.slope[j]);
    }
  }
  EXPECT_GT(rounds, 15);  // and not one each
  return rounds;
}

TEST(StageLanes, AreRefinedAsOneNumberAfterTheOther) {
  expect_the_refinement<2, 4>();
  expect_the_refinement<4, 8>();
  expect_the_refinement<4, 12>();
  expect_the_refinement<8, 16>();
  expect_the_refinement<4, 8>(0x1p-156);
  expect_the_refinement<4, 8>(0x1p-140);
}

// A small one that lacks a part of its own units ends sooner beside a length.
TEST(StageLanes, AreRefinedBesideALengthAsOneNumberAfterTheOther) {
  EXPECT_LT((expect_the_refinement<4, 8, true>(0x1p-60, 1)),
            (expect_the_refinement<4, 8>(0x1p-60)));
  EXPECT_LT((expect_the_refinement<8, 16, true>(0x1p-60, 1)),
            (expect_the_refinement<8, 16>(0x1p-60)));
}

TEST(StageLanes, GoInAndOutOfArraysInTheirOrder) {
  double from[16];
  double to[16] = {};
  for (int j = 0; j < 16; ++j) from[j] = j;
  Lanes<16>::put(to, Lanes<16>::at(from));
  Lanes<8>::add(to + 8, Lanes<8>::at(from));
  for (int j = 0; j < 16; ++j) EXPECT_EQ(to[j], j < 8 ? j : 2 * j - 8);
}

// Of this many packs, whatever the registers: what the sum loses is in the other number.
template <int W, int Count>
void expect_the_sum_of_stages() {
  Numbers numbers;
  double lost_before = 0;
  for (int k = 0; k < 20; ++k) {
    stage_packs::RefinementInLanes<Lanes<W>, of_double::Refinement<2 * Count, 2 * Count>> refined;
    __float128 exact = 0.25;
    for (int j = 0; j < 2 * Count; ++j) {
      refined.slope[j] = numbers.next() * (j % 3 == 0 ? 0x1p-20 : 1);
      refined.change[j] = numbers.next() * 0x1p-54;
      if (j >= Count) exact += __float128(refined.slope[j]) + refined.change[j];
    }
    double value = numbers.next();  // is set
    double lost = 0.25;             // is added to
    stage_packs::collect_stages(value, lost, refined, Count, Count);
    EXPECT_LE(std::abs(double(exact - value - lost)), 0x1p-53);
    const double rounded = double(exact - 0.25);
    EXPECT_NEAR(value, rounded, 4 * Count * 0x1p-53);
    lost_before += std::abs(lost - 0.25);

    // Pack after pack, then half after half, one number after the other.
    double* const sum = refined.slope + Count;
    double* const rest = refined.change + Count;
    const auto add = [&](int to, int from) {
      double error = 0;
      of_double::two_sum(sum[to], error, sum[from]);
      rest[to] = (rest[to] + rest[from]) + error;
    };
    for (int j = W; j < Count; ++j) add(j % W, j);
    for (int half = W / 2; half > 0; half /= 2) {
      for (int j = 0; j < half; ++j) add(j, j + half);
    }
    EXPECT_EQ(value, sum[0]);
    EXPECT_EQ(lost, 0.25 + rest[0]);
  }
  EXPECT_GT(lost_before, 0x1p-53);
}

TEST(StageLanes, AreCollectedWithoutALoss) {
  expect_the_sum_of_stages<2, 2>();
  expect_the_sum_of_stages<4, 4>();
  expect_the_sum_of_stages<8, 8>();
  expect_the_sum_of_stages<2, 6>();
  expect_the_sum_of_stages<4, 12>();
  expect_the_sum_of_stages<8, 16>();
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
