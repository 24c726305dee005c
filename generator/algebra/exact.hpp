// Exact rational numbers, and their correctly rounded images in a floating-point scalar.
#pragma once

#include <gmpxx.h>

#include <optional>
#include <string>
#include <string_view>

namespace hamgen {

using Integer = mpz_class;
using Rational = mpq_class;

// "12", "0.1", "1.5e-3", exactly.  The literal must be well formed: digits, optional fraction,
// optional exponent; empty if the exponent is outside [-400, 400] (see bad numbers in the lexer).
[[nodiscard]] std::optional<Rational> parse_decimal(std::string_view literal);

// The double nearest to the value, ties to even; +-inf on overflow.
[[nodiscard]] double to_double(const Rational& value);
[[nodiscard]] Rational from_double(double value);  // exact; the value must be finite

// The value as sum of doubles hi + lo + lower, each the nearest to what is left (159 bits).
struct TripleDouble {
  double hi = 0.0;
  double lo = 0.0;
  double lower = 0.0;
};
[[nodiscard]] TripleDouble to_triple(const Rational& value);

// The shortest decimal that reads back as the nearest double, in any locale: "0.1", "1e-30", "2.0".
[[nodiscard]] std::string shortest_decimal(double value);

// "3", "-1/12": exact text.
[[nodiscard]] std::string to_text(const Rational& value);

// base^exponent for an integer exponent; empty if base is 0 and exponent < 0, or if the result
// would need more than 4096 bits.
[[nodiscard]] std::optional<Rational> integer_power(const Rational& base, long exponent);

}  // namespace hamgen
