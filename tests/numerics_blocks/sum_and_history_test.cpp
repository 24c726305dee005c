// Sums that keep what they lose, and predictions from what has been.
#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class TwoSum : public ::testing::Test {};
TYPED_TEST_SUITE(TwoSum, EveryScalar);

TYPED_TEST(TwoSum, WhatIsLostIsInTheCarry) {
  using Real = typename TypeParam::Scalar;
  const Real unit = TypeParam::unit;
  Real value = 1;
  Real carry = 7;  // of no consequence: a caller that wants it adds it to the increment
  TypeParam::add(value, carry, Real(0.75) * unit);
  EXPECT_TRUE(value == 1 + unit);
  EXPECT_TRUE(carry == Real(-0.25) * unit);
}

// Dekker's shorter sum needs the larger summand first.
TYPED_TEST(TwoSum, TheIncrementMayBeTheLargerOne) {
  using Real = typename TypeParam::Scalar;
  const Real unit = TypeParam::unit;
  Real value = Real(0.75) * unit;
  Real carry = 0;
  TypeParam::add(value, carry, Real(1));
  EXPECT_TRUE(value == 1 + unit);
  EXPECT_TRUE(carry == Real(-0.25) * unit);
}

// Each of 1024 increments of unit/16 is below half a unit of 1, and would be lost alone.
TYPED_TEST(TwoSum, SmallIncrementsAddUp) {
  using Real = typename TypeParam::Scalar;
  Real value = 1;
  Real carry = 0;
  for (int i = 0; i < 1024; ++i) TypeParam::add(value, carry, carry + TypeParam::unit / 16);
  EXPECT_TRUE(value + carry == 1 + 64 * TypeParam::unit);
}

template <class Blocks>
class History : public ::testing::Test {};
TYPED_TEST_SUITE(History, EveryScalar);

// A polynomial of degree 3 in integers, small enough to be exact in a float: once degree 3 is known
// its prediction is the next value itself, and no higher degree is better.
TYPED_TEST(History, APolynomialIsGoneOnWithExactly) {
  using Real = typename TypeParam::Scalar;
  auto value = [](int k, int i) { return Real((k - 9) * (k - 10) * (k - 11 + i) + 3 * k); };
  typename TypeParam::template Past<2> past;
  for (int k = 0; k < 40; ++k) {
    Real x[2] = {value(k, 0), value(k, 1)};
    if (k >= 8) {
      Real predicted[2];
      past.extrapolate(predicted);
      EXPECT_TRUE(predicted[0] == x[0]) << k;
      EXPECT_TRUE(predicted[1] == x[1]) << k;
    }
    past.record(x);
  }
  EXPECT_EQ(past.best, 3);
}

// What comes after the next value is what the same polynomial says of it.
TYPED_TEST(History, APolynomialIsGoneOnWithTwiceExactly) {
  using Real = typename TypeParam::Scalar;
  auto value = [](int k, int i) { return Real((k - 9) * (k - 10) * (k - 11 + i) + 3 * k); };
  typename TypeParam::template Past<2> past;
  for (int k = 0; k < 40; ++k) {
    if (k >= 8) {
      Real after[2];
      TypeParam::extrapolate_twice(past, after);
      EXPECT_TRUE(after[0] == value(k + 1, 0)) << k;
      EXPECT_TRUE(after[1] == value(k + 1, 1)) << k;
    }
    const Real x[2] = {value(k, 0), value(k, 1)};
    past.record(x);
  }
}

// Of any sequence it is what the history would predict if its prediction came true.
TYPED_TEST(History, ItIsGoneOnWithTwiceAsIfThePredictionCameTrue) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template Past<1> past;
  for (int k = 0; k < 60; ++k) {
    const Real x[1] = {Real((k * k * 7 + k * 3) % 11)};
    past.record(x);
    if (past.age == 15) continue;  // the next record chooses another degree
    auto come_true = past;
    Real next[1];
    past.extrapolate(next);
    come_true.record(next);
    Real expected[1];
    come_true.extrapolate(expected);
    Real after[1];
    TypeParam::extrapolate_twice(past, after);
    EXPECT_TRUE(after[0] == expected[0]) << k;
  }
}

// Of an alternating sequence the last value misses by 2, its line by 4, its parabola by 8.
TYPED_TEST(History, NoDegreeIsHigherThanItHelps) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template Past<1> past;
  for (int k = 0; k < 64; ++k) {
    Real x[1] = {Real(k % 2 == 0 ? 1 : -1)};
    past.record(x);
  }
  EXPECT_EQ(past.best, 0);
  EXPECT_LE(past.known, 2);
}

// What was a line becomes a parabola: the degree follows within 16 steps.
TYPED_TEST(History, TheDegreeIsChosenAnew) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template Past<1> past;
  for (int k = 0; k < 200; ++k) {
    const int bent = k < 100 ? 0 : (k - 100) * (k - 100);
    Real x[1] = {Real(k + bent)};
    if (k >= 99) {
      if (k == 99) {
        EXPECT_EQ(past.best, 1);
      }
    }
    past.record(x);
  }
  EXPECT_EQ(past.best, 2);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
