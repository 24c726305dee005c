#include "generator/readback/precision.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

namespace {

constexpr std::array kPrecisions = {
    Precision{"float", "float", "float32", 24, -149, "f", "3.0e38f"},
    Precision{"double", "double", "float64", 53, -1074, "", "1.0e308"},
    Precision{"long-double", "long double", "long_double", 64, -16445, "L", "1.0e4932L"},
    Precision{"quad", "__float128", "quad", 113, -16494, "", "1.0e308"},
};

Rational two_to(long exponent) {
  Rational result(1);
  const auto size = static_cast<mp_bitcnt_t>(std::abs(exponent));
  if (exponent >= 0) {
    mpq_mul_2exp(result.get_mpq_t(), result.get_mpq_t(), size);
  } else {
    mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), size);
  }
  return result;
}

// 2^e <= |value| < 2^(e + 1).
long exponent_of(const Rational& value) {
  const auto bits = [](const Integer& x) {
    return static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2));
  };
  const Rational size = abs(value);
  const long guess = bits(size.get_num()) - bits(size.get_den());
  return size < two_to(guess) ? guess - 1 : guess;
}

Rational last_place(const Rational& value, int bits, int low) {
  return two_to(std::max<long>(exponent_of(value) - bits + 1, low));
}

constexpr int kMostDigits = 20000;

struct Digits {
  Integer mantissa = 0;
  long behind_point = 0;
  bool has_point = false;
  std::size_t length = 0;  // of the text
};

Digits read_digits(std::string_view text, int base) {
  Digits result;
  for (const char c : text) {
    const bool small = c >= 'a' && c <= 'f';
    const bool large = c >= 'A' && c <= 'F';
    const bool digit = (c >= '0' && c <= '9') || (base == 16 && (small || large));
    if (c == '.' && !result.has_point) {
      result.has_point = true;
    } else if (digit) {
      const int value = small ? c - 'a' + 10 : large ? c - 'A' + 10 : c - '0';
      result.mantissa = result.mantissa * base + value;
      if (result.has_point) ++result.behind_point;
    } else {
      break;
    }
    ++result.length;
  }
  return result;
}

Rational power(int base, long exponent) {
  Integer size;
  mpz_ui_pow_ui(size.get_mpz_t(), static_cast<unsigned long>(base),
                static_cast<unsigned long>(std::abs(exponent)));
  return exponent >= 0 ? Rational(size) : Rational(Integer(1), size);
}

// The exponent behind its letter, with what it takes of the text.
std::optional<long> read_exponent(std::string_view& text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  long exponent = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
  if (error != std::errc{} || std::abs(exponent) > kMostDigits) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return exponent;
}

}  // namespace

const Precision& precision_of(std::string_view scalar) {
  if (scalar.empty()) scalar = "double";
  const auto* const found = std::ranges::find(kPrecisions, scalar, &Precision::scalar);
  if (found == kPrecisions.end()) internal_error("no scalar of this name");
  return *found;
}

Rational rounded(const Rational& value, int bits, int low) {
  if (value == 0) return value;
  const Rational place = last_place(value, bits, low);
  const Rational scaled = value / place;
  Integer below;
  mpz_fdiv_q(below.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  const Rational rest = scaled - Rational(below);
  const Rational half(1, 2);
  const bool up = rest > half || (rest == half && mpz_odd_p(below.get_mpz_t()) != 0);
  return Rational(up ? below + 1 : below) * place;
}

Rational rounded(const Rational& value, const Precision& precision) {
  return rounded(value, precision.bits, precision.low);
}

std::optional<CppLiteral> read_literal(std::string_view text) {
  if (text.size() > static_cast<std::size_t>(kMostDigits)) return {};
  const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
  if (hexadecimal) text.remove_prefix(2);
  const Digits digits = read_digits(text, hexadecimal ? 16 : 10);
  text.remove_prefix(digits.length);
  long exponent = 0;
  const char* letters = hexadecimal ? "pP" : "eE";
  const bool has_exponent =
      !text.empty() && (text.front() == letters[0] || text.front() == letters[1]);
  if (has_exponent) {
    text.remove_prefix(1);
    const std::optional<long> found = read_exponent(text);
    if (!found) return {};
    exponent = *found;
  }
  CppLiteral result;
  result.is_integer = !digits.has_point && !has_exponent;
  Rational value(digits.mantissa);
  value *=
      power(hexadecimal ? 16 : 10, -digits.behind_point) * power(hexadecimal ? 2 : 10, exponent);
  if (text == "f" || text == "F") {
    result.bits = 24;
  } else if (text == "l" || text == "L") {
    result.bits = 64;
  } else if (!text.empty()) {
    return {};
  }
  if (result.is_integer && !text.empty()) return {};
  const int low = result.bits == 24 ? -149 : result.bits == 64 ? -16445 : -1074;
  result.value = result.is_integer ? value : rounded(value, result.bits, low);
  return result;
}

bool is_rounded(const Rational& written, const Rational& exact, const Precision& precision) {
  if (written == rounded(exact, precision)) return true;
  if (precision.bits <= 53 || exact == 0) return false;
  const Rational place = last_place(exact, precision.bits, precision.low);
  return abs(written - exact) <= place * (Rational(1, 2) + two_to(-20));
}

}  // namespace hamgen
