// Exact numbers and the literals they become.
#include "generator/algebra/exact.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <regex>

#include "generator/formats/literal.hpp"

namespace hamgen {
namespace {

Rational decimal(const char* text) { return *parse_decimal(text); }

TEST(Exact, DecimalsAreReadExactly) {
  EXPECT_EQ(decimal("0.1"), Rational(1, 10));
  EXPECT_EQ(decimal("1.5e-3"), Rational(3, 2000));
  EXPECT_EQ(decimal("12"), Rational(12));
  EXPECT_EQ(decimal("1e2"), Rational(100));
  EXPECT_EQ(decimal(".5"), Rational(1, 2));
  EXPECT_FALSE(parse_decimal("1e999999999").has_value());
  EXPECT_EQ(decimal("0e999999999"), 0);
  EXPECT_EQ(decimal("0.00e-99999999999999999999"), 0);
  EXPECT_FALSE(parse_decimal("0e").has_value());
  EXPECT_FALSE(parse_decimal("0e1x").has_value());
  EXPECT_FALSE(parse_decimal("e5").has_value());
}

TEST(Exact, TheNearestDoubleIsTheOneTheCompilerChooses) {
  EXPECT_EQ(to_double(decimal("0.1")), 0.1);
  EXPECT_EQ(to_double(Rational(1, 3)), 1.0 / 3.0);
  EXPECT_EQ(to_double(decimal("1e-320")), 1e-320);
  EXPECT_EQ(to_double(decimal("123456789012345678901")), 123456789012345678901.0);
  EXPECT_EQ(to_double(decimal("2.2250738585072011e-308")), 2.2250738585072011e-308);
  EXPECT_EQ(to_double(decimal("4.9406564584124654e-324")), 4.9406564584124654e-324);
  EXPECT_EQ(to_double(decimal("2e-324")), 0.0);
  EXPECT_EQ(to_double(decimal("1e309")), std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_double(-decimal("1e309")), -std::numeric_limits<double>::infinity());
  // Halfway between two doubles: to the even one.
  EXPECT_EQ(to_double(Rational("9007199254740993")), 9007199254740992.0);
  EXPECT_EQ(to_double(Rational("9007199254740995")), 9007199254740996.0);
}

TEST(Exact, AnyDoubleComesBackFromItsExactValue) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(to_double(from_double(value)), value);
    EXPECT_EQ(std::strtod(shortest_decimal(value).c_str(), nullptr), value);
  }
}

TEST(Exact, ThreeDoublesHoldAHundredAndFiftyBits) {
  for (const Rational& value : {Rational(1, 3), decimal("0.1"), decimal("123456789012345678901")}) {
    const TripleDouble parts = to_triple(value);
    const Rational sum = from_double(parts.hi) + from_double(parts.lo) + from_double(parts.lower);
    Rational bound = abs(value);
    mpq_div_2exp(bound.get_mpq_t(), bound.get_mpq_t(), 159);
    EXPECT_LE(abs(sum - value), bound);
  }
}

// 2^(2 10^11) would not fit into the memory.
TEST(Exact, PowersThatAreTooLongAreRefusedBeforeTheyAreMade) {
  EXPECT_EQ(integer_power(Rational(-2, 3), 3), Rational(-8, 27));
  EXPECT_EQ(integer_power(Rational(-2, 3), -3), Rational(-27, 8));
  EXPECT_TRUE(integer_power(2, 4095));  // 4096 bits
  EXPECT_FALSE(integer_power(2, 4096));
  EXPECT_EQ(integer_power(-1, 1000000001), Rational(-1));
  Integer huge = 1;
  mpz_setbit(huge.get_mpz_t(), 50'000'000);
  for (const long exponent : {4096L, -4096L}) {
    EXPECT_FALSE(integer_power(Rational(huge), exponent));
    EXPECT_FALSE(integer_power(Rational(Integer(1), huge), exponent));
  }
}

TEST(Literal, OfADoubleIsTheShortestThatReadsBack) {
  const ScalarType& scalar = find_scalar("double");
  EXPECT_EQ(literal(decimal("0.1"), scalar), "0.1");
  EXPECT_EQ(literal(Rational(1, 2), scalar), "0.5");
  EXPECT_EQ(literal(Rational(1, 3), scalar), "(1.0 / 3.0)");
  EXPECT_EQ(literal(decimal("1e-320"), scalar), "1e-320");
  EXPECT_EQ(literal(decimal("123456789012345678901"), scalar), "123456789012345683968.0");
}

Rational two_to(long exponent) {
  Rational result(1);
  if (exponent >= 0) {
    mpq_mul_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  } else {
    mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  }
  return result;
}

// Integers of at most 64 bits times powers of two: a sum of two for quad.
TEST(Literal, BeyondTheRangeOfDoubleIsTheNearestNumberInHexadecimal) {
  const std::regex part("0x([0-9a-f]+)p(-?[0-9]+)L");
  for (const char* name : {"long-double", "quad"}) {
    const ScalarType& scalar = find_scalar(name);
    for (int k = 0; k < 40; ++k) {
      Rational value = Rational(2 * k + 1, 3) * decimal("1e-290");
      if (k % 2 != 0) value = -1 / value * decimal("1e20");
      const std::string text = literal(value, scalar);
      Rational sum = 0;
      for (std::sregex_iterator it(text.begin(), text.end(), part), end; it != end; ++it) {
        const Integer mantissa((*it)[1].str(), 16);
        EXPECT_LE(mpz_sizeinbase(mantissa.get_mpz_t(), 2), 64U) << text;
        sum += mantissa * two_to(std::stol((*it)[2]));
      }
      if (text.starts_with('-')) sum = -sum;
      // 2^last <= |value| < 2^(last + 1): the unit of its last digit is 2^(last + 1 - digits).
      long last = 0;
      while (abs(value) < two_to(last)) --last;
      while (abs(value) >= two_to(last + 1)) ++last;
      EXPECT_LE(abs(sum - value), two_to(last - scalar.digits)) << name << " " << text;
    }
  }
}

TEST(Literal, HasASuffixInFloatAndLongDouble) {
  EXPECT_EQ(literal(Rational(1, 2), find_scalar("float")), "0.5f");
  EXPECT_EQ(literal(Rational(1, 2), find_scalar("long-double")), "0.5L");
  EXPECT_EQ(literal(Rational(1, 2), find_scalar("quad")), "Real(0.5)");
  EXPECT_EQ(literal(decimal("0.1"), find_scalar("float")), "0.1f");
}

}  // namespace
}  // namespace hamgen
