// Sums of fractions that are zero, and that are not.
#include "generator/verify/numerator.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace hamgen {
namespace {

using GiNaC::ex;
using GiNaC::pow;
using GiNaC::symbol;

const symbol x("x"), y("y"), z("z");

TEST(Numerator, OfWhatIsZeroIsZero) {
  const std::vector<ex> zeros = {
      1 / (x - y) + 1 / (y - x),
      1 / (x - y) + 3 / (3 * y - 3 * x),
      1 / (pow(x, 2) - pow(y, 2)) - 1 / ((x - y) * (x + y)),
      x / (x + y) + y / (x + y) - 1,
      1 / (1 + 1 / x) - x / (x + 1),
      pow(1 / x + 1 / y, -2) - pow(x * y, 2) / pow(x + y, 2),
      pow(x / (x + y) - 1, 3) + pow(y / (x + y), 3),
      1 / (x * y) - 1 / (x * y + x * y * z) - z / (x * y * (1 + z)),
      sin(x) / (2 * cos(y)) - sin(x) * pow(cos(y), 2) / (2 * pow(cos(y), 3)),
      pow(x, ex(1) / 3) / y * pow(x, ex(2) / 3) - x / y,
      sin(1 / x + 1 / y) - sin((x + y) / (x * y)),
      pow(pow(x, 100000) * y, -1) - pow(x, -100000) / y,
      // Roots in denominators, and powers that add up to whole ones.
      (pow(x, 2) + pow(y, 2)) * pow(pow(x, 2) + pow(y, 2), -ex(1) / 3) -
          pow(pow(x, 2) + pow(y, 2), ex(2) / 3),
      pow(x, 2) * pow(pow(x, 2) + pow(y, 2), -ex(1) / 3) +
          pow(y, 2) * pow(pow(x, 2) + pow(y, 2), -ex(1) / 3) -
          pow(pow(x, 2) + pow(y, 2), ex(2) / 3),
      pow(x, -z) * (pow(x, z) + 1) - 1 - pow(x, -z),
      pow(x * y, -x / (x + z) - z / (x + z)) - 1 / (x * y),
  };
  for (const ex& e : zeros) EXPECT_TRUE(numerator(e).is_zero()) << e << " gives " << numerator(e);
}

// Its powers are counted, not lost in 32 bits.
TEST(Numerator, OfPowersOfPowersIsRefusedWhereTheyAreTooLarge) {
  const ex inverse = (y + 1) / pow(x, 65536) - y / pow(x, 65536);
  EXPECT_THROW((void)numerator(pow(inverse, 65536) - 1), std::length_error);
  EXPECT_THROW((void)numerator(pow(inverse, -65536) - 1), std::length_error);
  EXPECT_FALSE(numerator(pow(inverse, 10) - 1).is_zero());
}

// A polynomial: no power is negative, as those who look for powers of roots want it.
TEST(Numerator, HasNoNegativePowers) {
  for (const ex& e : {pow(x * y, -x / (x + z) - z / (x + z)) - x / y,
                      exp(log(1 / x) + 1 / (y + 1) + y / (y + 1) - 1) - x}) {
    const ex found = numerator(e);
    EXPECT_GE(found.ldegree(x), 0) << found;
    EXPECT_GE(found.ldegree(y), 0) << found;
  }
}

TEST(Numerator, OfWhatIsNotZeroIsNot) {
  const std::vector<ex> others = {
      1 / (x - y) - 1 / (y - x),
      1 / (x - y) + 2 / (3 * y - 3 * x),
      1 / (x + y) - 1 / (x - y),
      x / (x + y) + y / (x + y),
      1 / (1 + 1 / x) - x / (x - 1),
      sin(x) / cos(y) - sin(y) / cos(x),
      pow(x / (x + y) - 1, 3) - pow(y / (x + y), 3),
      pow(x * y, -x / (x + z) - z / (x + z)) - x / y,
      (pow(x * y, ex(1) / 3) + 1) * (pow(x * y, -ex(4) / 3) + 1) - pow(x * y, ex(1) / 3) -
          pow(x * y, -ex(4) / 3) - 1 - x / y,
      exp(log(1 / x) + 1 / (y + 1) + y / (y + 1) - 1) - x,
  };
  for (const ex& e : others) EXPECT_FALSE(numerator(e).is_zero()) << e;
}

TEST(Numerator, IsTheFractionTimesItsDenominators) {
  EXPECT_TRUE((numerator(1 / x + 1 / pow(x, 2) + y) - (x + 1 + y * pow(x, 2))).is_zero());
  // Of 2 (x + y) one factor, of (x + y)^2 the larger power.
  const ex found = numerator(1 / (2 * x + 2 * y) + z / pow(x + y, 2));
  EXPECT_TRUE((found - ((x + y) / 2 + z).expand()).is_zero()) << found;
  // A denominator has 1 before its first term, whichever that is.
  const ex of_two = numerator(1 / (2 * x + 3 * y) + z / x);
  const ex wanted = (x + z * (2 * x + 3 * y)).expand();
  EXPECT_TRUE((of_two - wanted / 2).expand().is_zero() || (of_two - wanted / 3).expand().is_zero())
      << of_two;
}

TEST(Numerator, IsNoneWhereADenominatorVanishes) {
  EXPECT_THROW((void)numerator(1 / (pow(x + y, 2) - pow(x, 2) - 2 * x * y - pow(y, 2))),
               std::overflow_error);
}

// Forty denominators have no common one that could be written down.
TEST(Numerator, OfManyDenominatorsIsFoundWhereTheyCancelAndElseRefused) {
  ex zero = 0;
  ex other = 0;
  for (int i = 0; i < 40; ++i) {
    const symbol a, b;
    zero += 1 / (a + b) - 2 / (2 * a + 2 * b);
    other += 1 / (a + b) - 1 / (2 * a + b);
  }
  EXPECT_TRUE(numerator(zero).is_zero());
  EXPECT_THROW((void)numerator(other), std::length_error);
  EXPECT_THROW((void)numerator(pow(x + y, 1000)), std::length_error);
  EXPECT_THROW((void)numerator(pow(x, GiNaC::numeric("1000000000000"))), std::length_error);
}

}  // namespace
}  // namespace hamgen
