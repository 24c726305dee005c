#include "generator/formats/scalar.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

// Of quad numbers the exponents of long double, in which they are written, less the digits that
// must not get lost below them.
constexpr std::array kScalars = {
    ScalarType{"float", "float", 24, "f", "0x1p-23f", "3.0e38f", -149, 128, "1.4e-45 and 3.4e38",
               "float32"},
    ScalarType{"double", "double", 53, "", "0x1p-52", "1.0e308", -1074, 1024,
               "4.9e-324 and 1.7e308", "float64"},
    ScalarType{"long-double", "long double", 64, "L", "0x1p-63L", "1.0e4932L", -16445, 16384,
               "3.6e-4951 and 1.1e4932", "long_double"},
    ScalarType{"quad", "__float128", 113, "", "Real(0x1p-112)", "Real(1.0e308)", -16300, 16384,
               "1e-4906 and 1.1e4932", "quad"},
};

// 2^exponent.
Rational power_of_two(long exponent) {
  Rational result(1);
  if (exponent >= 0) {
    mpq_mul_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  } else {
    mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  }
  return result;
}

// Six digits, whatever the exponent: "1.5e-400".
std::string scientific(const Rational& value) {
  mp_exp_t exponent = 0;
  std::string digits = mpf_class(abs(value), 64).get_str(exponent, 10, 6);
  if (digits.size() > 1) digits.insert(1, ".");
  return fmt::format("{}{}e{}", sgn(value) < 0 ? "-" : "", digits, exponent - 1);
}

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

std::span<const ScalarType> all_scalars() { return kScalars; }

const ScalarType& find_scalar(std::string_view name) {
  if (name.empty()) name = "double";
  for (const ScalarType& scalar : kScalars) {
    if (scalar.name == name) return scalar;
  }
  throw UsageError(
      fmt::format("unknown scalar '{}'; there are float, double, long-double, quad", name));
}

bool is_in_range(const Rational& value, const ScalarType& scalar) {
  if (value == 0) return true;
  const Rational size = abs(value);
  // From half a last bit below 2^high on, and up to half of 2^low, it rounds to infinity and to 0.
  return size < power_of_two(scalar.high) - power_of_two(scalar.high - scalar.digits - 1) &&
         size > power_of_two(scalar.low - 1);
}

std::string out_of_range_message(const Rational& value, const ScalarType& scalar) {
  return fmt::format("{}, outside the range of {}", scientific(value), scalar.name);
}

std::string out_of_range_help(const Rational& value, const ScalarType& scalar) {
  const std::string text = fmt::format("numbers lie between {}; choose other units", scalar.range);
  for (const ScalarType& wider : kScalars) {
    if (wider.digits > scalar.digits && is_in_range(value, wider))
      return text + fmt::format(", or --scalar {}", wider.name);
  }
  return text;
}

OutOfRange::OutOfRange(const Rational& value, const ScalarType& scalar)
    : UsageError(fmt::format("the step needs the constant {}\nhelp: {}",
                             out_of_range_message(value, scalar),
                             out_of_range_help(value, scalar))),
      diagnostic_{.message = "the step needs the constant " + out_of_range_message(value, scalar),
                  .help = out_of_range_help(value, scalar)} {}

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

}  // namespace hamgen
