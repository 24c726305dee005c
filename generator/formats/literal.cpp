#include "generator/formats/literal.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace hamgen {

namespace {

// Is the value a number of the type without rounding (exponent range apart)?
bool is_exact(const Rational& value, int digits) {
  const Integer& under = value.get_den();
  if (mpz_popcount(under.get_mpz_t()) != 1) return false;
  const Integer over = abs(value.get_num());
  if (over == 0) return true;
  const auto trailing = mpz_scan1(over.get_mpz_t(), 0);
  const auto bits = mpz_sizeinbase(over.get_mpz_t(), 2);
  return bits - trailing <= static_cast<std::size_t>(digits) &&
         mpz_sizeinbase(under.get_mpz_t(), 2) < 1000 && bits < 1000;
}

std::string with_point(std::string text) {
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string shortest_float(float value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return with_point(std::string(buffer.data(), end));
}

// Beyond the range of double, or so near its end that its parts would be rounded.
bool needs_a_wide_exponent(const Rational& value) {
  if (value == 0) return false;
  const long over = static_cast<long>(mpz_sizeinbase(value.get_num().get_mpz_t(), 2));
  const long under = static_cast<long>(mpz_sizeinbase(value.get_den().get_mpz_t(), 2));
  return over - under < -840 || over - under > 1000;
}

// The nearest multiple of 2^exponent, as that multiple.
Integer nearest_multiple(const Rational& value, long exponent) {
  const Rational scaled = value * power_of_two(-exponent) + Rational(1, 2);
  Integer floor;
  mpz_fdiv_q(floor.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  return floor;
}

// Hexadecimal, with the exponent of long double: one number, or the sum of two for quad.
std::string wide_literal(const Rational& value, int digits) {
  const Rational size = abs(value);
  const long bits = static_cast<long>(mpz_sizeinbase(size.get_num().get_mpz_t(), 2)) -
                    static_cast<long>(mpz_sizeinbase(size.get_den().get_mpz_t(), 2)) + 1;
  // 2^(bits - 2) < size < 2^bits: the mantissa has `digits` bits, or one too few.
  long exponent = bits - digits;
  Integer mantissa = nearest_multiple(size, exponent);
  if (static_cast<long>(mpz_sizeinbase(mantissa.get_mpz_t(), 2)) < digits) {
    mantissa = nearest_multiple(size, --exponent);
  }
  auto spell = [](const Integer& m, long e) {
    return "0x" + m.get_str(16) + fmt::format("p{}L", e);
  };
  const std::string sign = value < 0 ? "-" : "";
  if (digits <= 64) return sign + spell(mantissa, exponent);
  const Integer low = mantissa % (Integer(1) << 56);
  const Integer high = mantissa >> 56;
  return fmt::format("{}(Real({}) + Real({}))", sign, spell(high, exponent + 56),
                     spell(low, exponent));
}

bool fits_exactly(const Integer& value) { return mpz_sizeinbase(value.get_mpz_t(), 2) <= 53; }

}  // namespace

std::string literal(const Rational& value, const ScalarType& scalar) {
  if (!is_in_range(value, scalar)) throw OutOfRange(value, scalar);
  const bool quad = scalar.digits == 113;
  if (scalar.digits > 53 && needs_a_wide_exponent(value)) return wide_literal(value, scalar.digits);
  auto spell = [&](double x) {
    // A long double literal is read with 64 bits: only the exact decimal, or hexadecimal, will do.
    if (scalar.digits == 64 &&
        parse_decimal(shortest_decimal(std::fabs(x))) != from_double(std::fabs(x))) {
      return fmt::format("{:a}L", x);
    }
    return quad ? fmt::format("Real({})", shortest_decimal(x))
                : shortest_decimal(x) + std::string(scalar.suffix);
  };
  if (is_exact(value, std::min(scalar.digits, 53))) return spell(to_double(value));
  // A quotient of two exact numbers is correctly rounded by the compiler.
  const bool quotient = fits_exactly(value.get_num()) && fits_exactly(value.get_den());
  const std::string decimal = shortest_decimal(to_double(value));
  if (scalar.digits > 53) {
    if (quotient) {
      return fmt::format("({} / {})", spell(value.get_num().get_d()),
                         spell(value.get_den().get_d()));
    }
    const TripleDouble parts = to_triple(value);
    return fmt::format("({} + {} + {})", spell(parts.lower), spell(parts.lo), spell(parts.hi));
  }
  if (scalar.digits == 24) {
    // Through the decimal expansion of the exact value, rounded once to float: a double that is
    // not a tie of floats rounds to the same float, and a tie is told by the remainder.
    const double nearest = to_double(value);
    float rounded = static_cast<float>(nearest);
    const Rational there = from_double(static_cast<double>(rounded));
    for (const float other :
         {std::nextafter(rounded, -3.0e38F), std::nextafter(rounded, 3.0e38F)}) {
      if (abs(from_double(static_cast<double>(other)) - value) < abs(there - value))
        rounded = other;
    }
    return shortest_float(rounded) + "f";
  }
  if (quotient && decimal.size() > 14 && value.get_den() < 100000) {
    return fmt::format("({} / {})", shortest_decimal(value.get_num().get_d()),
                       shortest_decimal(value.get_den().get_d()));
  }
  return decimal;
}

std::string function_suffix(const ScalarType& scalar) {
  return scalar.suffix == "L" ? "l" : std::string(scalar.suffix);
}

}  // namespace hamgen
