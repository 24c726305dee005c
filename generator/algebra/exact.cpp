#include "generator/algebra/exact.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace hamgen {
namespace {

constexpr long largest_exponent = 400;
constexpr std::size_t most_bits = 4096;

Integer power_of(unsigned long base, unsigned long exponent) {
  Integer result;
  mpz_ui_pow_ui(result.get_mpz_t(), base, exponent);
  return result;
}

std::size_t bits(const Integer& value) { return mpz_sizeinbase(value.get_mpz_t(), 2); }

// floor(log2(value)) for value > 0.
long binary_exponent(const Rational& value) {
  const long estimate =
      static_cast<long>(bits(value.get_num())) - static_cast<long>(bits(value.get_den()));
  // 2^(estimate - 1) < value < 2^(estimate + 1)
  Rational scale(1);
  if (estimate >= 0) {
    mpq_mul_2exp(scale.get_mpq_t(), scale.get_mpq_t(), static_cast<unsigned long>(estimate));
  } else {
    mpq_div_2exp(scale.get_mpq_t(), scale.get_mpq_t(), static_cast<unsigned long>(-estimate));
  }
  return value >= scale ? estimate : estimate - 1;
}

// The integer nearest to a value >= 0, ties to even.
Integer round_to_even(const Rational& value) {
  Integer quotient;
  Integer rest;
  mpz_fdiv_qr(quotient.get_mpz_t(), rest.get_mpz_t(), value.get_num_mpz_t(), value.get_den_mpz_t());
  const int half = cmp(Integer(2 * rest), value.get_den());
  if (half > 0 || (half == 0 && mpz_odd_p(quotient.get_mpz_t()) != 0)) ++quotient;
  return quotient;
}

}  // namespace

std::optional<Rational> parse_decimal(std::string_view literal) {
  std::string digits;
  long exponent = 0;
  bool fraction = false;
  std::size_t i = 0;
  for (; i < literal.size() && literal[i] != 'e' && literal[i] != 'E'; ++i) {
    if (literal[i] == '.') {
      fraction = true;
      continue;
    }
    digits += literal[i];
    if (fraction) --exponent;
  }
  if (i < literal.size()) {
    ++i;
    if (i < literal.size() && literal[i] == '+') ++i;
    long written = 0;
    const char* end = literal.data() + literal.size();
    const auto [stop, error] = std::from_chars(literal.data() + i, end, written);
    const bool is_number = error != std::errc::invalid_argument && stop == end;
    const bool is_zero = digits.find_first_not_of('0') == std::string::npos;
    if (is_number && is_zero && !digits.empty()) return Rational(0);  // whatever its exponent
    if (!is_number || error != std::errc{} || std::abs(written) > largest_exponent)
      return std::nullopt;
    exponent += written;
  }
  if (digits.empty()) return std::nullopt;
  Rational value(Integer(digits, 10));
  const Integer scale = power_of(10, static_cast<unsigned long>(std::abs(exponent)));
  if (exponent >= 0) {
    value *= scale;
  } else {
    value /= scale;
  }
  return value;
}

double to_double(const Rational& value) {
  if (sgn(value) == 0) return 0.0;
  const Rational magnitude = abs(value);
  const long exponent = binary_exponent(magnitude);
  // The last bit weighs 2^(exponent - 52), but never less than the smallest subnormal, 2^-1074.
  const long last_bit = std::max(exponent - 52, -1074L);
  Rational scaled = magnitude;
  if (last_bit >= 0) {
    mpq_div_2exp(scaled.get_mpq_t(), scaled.get_mpq_t(), static_cast<unsigned long>(last_bit));
  } else {
    mpq_mul_2exp(scaled.get_mpq_t(), scaled.get_mpq_t(), static_cast<unsigned long>(-last_bit));
  }
  const Integer significand = round_to_even(scaled);  // at most 2^53: exact as a double
  return sgn(value) * std::ldexp(significand.get_d(), static_cast<int>(last_bit));
}

Rational from_double(double value) { return Rational(value); }

TripleDouble to_triple(const Rational& value) {
  TripleDouble triple;
  triple.hi = to_double(value);
  if (!std::isfinite(triple.hi)) return triple;
  const Rational after_hi = value - from_double(triple.hi);
  triple.lo = to_double(after_hi);
  triple.lower = to_double(after_hi - from_double(triple.lo));
  return triple;
}

std::string shortest_decimal(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string text(buffer.data(), end);
  const bool integral = text.find_first_not_of("-0123456789") == std::string::npos;
  return integral ? text + ".0" : text;
}

std::string to_text(const Rational& value) { return value.get_str(); }

std::optional<Rational> integer_power(const Rational& base, long exponent) {
  if (exponent == 0) return Rational(1);
  if (sgn(base) == 0) {
    if (exponent < 0) return std::nullopt;
    return Rational(0);
  }
  const auto count = static_cast<unsigned long>(std::abs(exponent));
  const std::size_t base_bits = std::max(bits(base.get_num()), bits(base.get_den()));
  const bool unit = abs(base) == 1;
  if (!unit && (count > most_bits || (base_bits - 1) * count > most_bits)) return std::nullopt;
  Integer numerator;
  Integer denominator;
  mpz_pow_ui(numerator.get_mpz_t(), base.get_num_mpz_t(), count);
  mpz_pow_ui(denominator.get_mpz_t(), base.get_den_mpz_t(), count);
  if (bits(numerator) > most_bits || bits(denominator) > most_bits) return std::nullopt;
  Rational result =
      exponent > 0 ? Rational(numerator, denominator) : Rational(denominator, numerator);
  result.canonicalize();
  return result;
}

}  // namespace hamgen
