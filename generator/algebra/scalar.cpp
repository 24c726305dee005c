#include "generator/algebra/scalar.hpp"

#include <fmt/format.h>

#include <array>

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

// Six digits, whatever the exponent: "1.5e-400".
std::string scientific(const Rational& value) {
  mp_exp_t exponent = 0;
  std::string digits = mpf_class(abs(value), 64).get_str(exponent, 10, 6);
  if (digits.size() > 1) digits.insert(1, ".");
  return fmt::format("{}{}e{}", sgn(value) < 0 ? "-" : "", digits, exponent - 1);
}

}  // namespace

Rational power_of_two(long exponent) {
  Rational result(1);
  if (exponent >= 0) {
    mpq_mul_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  } else {
    mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  }
  return result;
}

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

}  // namespace hamgen
