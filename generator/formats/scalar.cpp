#include "generator/formats/scalar.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

constexpr std::array kScalars = {
    ScalarType{"float", "float", 24, "f", "0x1p-23f", "3.0e38f"},
    ScalarType{"double", "double", 53, "", "0x1p-52", "1.0e308"},
    ScalarType{"long-double", "long double", 64, "L", "0x1p-63L", "1.0e4932L"},
    ScalarType{"quad", "__float128", 113, "", "Real(0x1p-112)", "Real(1.0e308)"},
};

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

bool fits_exactly(const Integer& value) { return mpz_sizeinbase(value.get_mpz_t(), 2) <= 53; }

}  // namespace

std::span<const ScalarType> all_scalars() { return kScalars; }

const ScalarType& find_scalar(std::string_view name) {
  if (name.empty()) name = "double";
  for (const ScalarType& scalar : kScalars) {
    if (scalar.name == name) return scalar;
  }
  throw UsageError(fmt::format(
      "unknown scalar '{}'; there are float, double, long-double, quad", name));
}

std::string literal(const Rational& value, const ScalarType& scalar) {
  const bool quad = scalar.digits == 113;
  auto spell = [&](double x) {
    // A long double literal is read with 64 bits: only the exact decimal, or hexadecimal, will do.
    if (scalar.digits == 64 && parse_decimal(shortest_decimal(std::fabs(x))) != from_double(std::fabs(x))) {
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
    for (const float other : {std::nextafter(rounded, -3.0e38F), std::nextafter(rounded, 3.0e38F)}) {
      if (abs(from_double(static_cast<double>(other)) - value) < abs(there - value)) rounded = other;
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
