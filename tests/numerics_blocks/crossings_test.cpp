// Where a quantity crosses zero within a step.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/numerics_blocks/every_scalar.hpp"

namespace hamgen::numerics_blocks_test {
namespace {

template <class Blocks>
class CrossingSearch : public ::testing::Test {
 public:
  using Number = typename Blocks::Scalar;

  // Of a quantity that is known exactly, and of what the cubic says of it.
  template <class Value, class Look>
  static std::vector<Number> found(const Value& value, const Look& look, bool rising = true,
                                   bool falling = true) {
    std::vector<Number> thetas;
    const auto after_part = [&](Number theta, Number& result) {
      result = value(theta);
      return result == result;
    };
    Blocks::crossings(after_part, look, value(Number(0)), value(Number(1)), rising, falling,
                      [&](Number theta) { thetas.push_back(theta); });
    return thetas;
  }
  // To rounding of theta: between two arguments so far apart there is the change of sign.
  template <class Value>
  static void expect_root(const Value& value, Number theta) {
    const Number near = 4 * Blocks::unit * theta;
    EXPECT_NE(value(theta - near) > 0, value(theta + near) > 0);
  }
};
TYPED_TEST_SUITE(CrossingSearch, EveryScalar);

TYPED_TEST(CrossingSearch, ARootIsFoundToRounding) {
  using Real = typename TypeParam::Scalar;
  const auto expect = [&](const auto& f) {
    const Real x = TypeParam::root_between(f, Real(0), f(Real(0)), Real(1), f(Real(1)));
    TestFixture::expect_root(f, x);
  };
  expect([](Real x) { return 3 * x * x * x + x - 1; });
  expect([](Real x) { return 1 - 1000000 * x; });                 // near one end
  expect([](Real x) { return Real(x < Real(1) / 3 ? -1 : 1); });  // the secant says nothing
  const auto nineth = [](Real x) {
    const Real y = 2 * x - 1;
    return y * y * y * y * y * y * y * y * y;  // flat: its value is 0 long before the root is met
  };
  const Real flat = TypeParam::root_between(nineth, Real(0), Real(-1), Real(1), Real(1));
  EXPECT_LE(TypeParam::absolute(nineth(flat)), TypeParam::unit);
}

TYPED_TEST(CrossingSearch, OneOrSeveralInTheOrderOfTimeAndByDirection) {
  using Real = typename TypeParam::Scalar;
  const auto two = [](Real x) { return (10 * x - 3) * (10 * x - 6); };
  std::vector<Real> thetas = TestFixture::found(two, two);
  ASSERT_EQ(thetas.size(), 2U);
  EXPECT_LT(thetas[0], thetas[1]);
  for (const Real theta : thetas) TestFixture::expect_root(two, theta);
  EXPECT_EQ(TestFixture::found(two, two, true, false), std::vector<Real>{thetas[1]});
  EXPECT_EQ(TestFixture::found(two, two, false, true), std::vector<Real>{thetas[0]});
  const auto close = [](Real x) { return (100 * x - 48) * (100 * x - 52); };
  EXPECT_EQ(TestFixture::found(close, close).size(), 2U);
  const auto three = [](Real x) { return (10 * x - 2) * (10 * x - 5) * (10 * x - 8); };
  EXPECT_EQ(TestFixture::found(three, three).size(), 3U);
}

TYPED_TEST(CrossingSearch, WhatNeverChangesSignIsNone) {
  using Real = typename TypeParam::Scalar;
  const auto touch = [](Real x) { return (2 * x - 1) * (2 * x - 1) + Real(1) / 1024; };
  EXPECT_TRUE(TestFixture::found(touch, touch).empty());
  const auto far = [](Real x) { return 100 + x; };
  int looks = 0;
  EXPECT_TRUE(TestFixture::found(far, [&](Real x) { return ++looks, far(x); }).empty());
  EXPECT_EQ(looks, 1);  // that is all it costs
}

// The cubic brackets; what counts is the value after a part of the step.
TYPED_TEST(CrossingSearch, TheCubicIsNotBelieved) {
  using Real = typename TypeParam::Scalar;
  const auto none = [](Real) { return Real(1) / 8; };
  const auto two = [](Real x) { return (10 * x - 3) * (10 * x - 6) / 8; };
  EXPECT_TRUE(TestFixture::found(none, two).empty());
  const auto shifted = [&](Real x) { return two(x + Real(1) / 64); };
  const std::vector<Real> thetas = TestFixture::found(two, shifted);
  ASSERT_EQ(thetas.size(), 2U);
  for (const Real theta : thetas) TestFixture::expect_root(two, theta);
}

TYPED_TEST(CrossingSearch, AZeroBelongsToWhatEndsThere) {
  using Real = typename TypeParam::Scalar;
  const auto ends = [](Real x) { return 1 - x; };
  EXPECT_EQ(TestFixture::found(ends, ends), std::vector<Real>{Real(1)});
  const auto begins = [](Real x) { return x; };
  EXPECT_TRUE(TestFixture::found(begins, begins).empty());
}

TYPED_TEST(CrossingSearch, WhatHasNoValueIsLeftOut) {
  using Real = typename TypeParam::Scalar;
  const auto line = [](Real x) { return 2 * x - 1; };
  int found = 0;
  const auto fails = [](Real, Real&) { return false; };
  TypeParam::crossings(fails, line, Real(-1), Real(1), true, true, [&](Real) { ++found; });
  const Real nothing = std::numeric_limits<double>::quiet_NaN();
  const auto works = [&](Real x, Real& result) {
    result = line(x);
    return true;
  };
  TypeParam::crossings(works, line, nothing, Real(1), true, true, [&](Real) { ++found; });
  TypeParam::crossings(works, line, Real(-1), 8 * TypeParam::most, true, true,
                       [&](Real) { ++found; });
  EXPECT_EQ(found, 0);
  TypeParam::crossings(works, line, Real(-1), Real(1), true, true, [&](Real) { ++found; });
  EXPECT_EQ(found, 1);
}

// s^3 - s, over a step of length 2: its derivative by the time is (3 s^2 - 1)/2.
TYPED_TEST(CrossingSearch, TheCubicIsThatOfBothEnds) {
  using Real = typename TypeParam::Scalar;
  for (int i = 0; i <= 8; ++i) {
    const Real s = Real(i) / 8;
    EXPECT_EQ(TypeParam::on_cubic(s, Real(2), Real(0), Real(-1) / 2, Real(0), Real(1)),
              s * s * s - s);
  }
}

TYPED_TEST(CrossingSearch, AListIsInTheOrderOfTimeAndOfEvents) {
  using Real = typename TypeParam::Scalar;
  typename TypeParam::template Crossings<3> list;
  const int events[] = {0, 1, 1, 2, 2};
  const int eighths[] = {4, 2, 6, 4, 1};
  for (int i = 0; i < 5; ++i) list.insert(events[i], Real(eighths[i]) / 8);
  ASSERT_EQ(list.count, 5);
  const int sorted[] = {2, 1, 0, 2, 1};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(list.event[i], sorted[i]) << i;
  for (int i = 1; i < 5; ++i) EXPECT_LE(list.theta[i - 1], list.theta[i]);
}

}  // namespace
}  // namespace hamgen::numerics_blocks_test
