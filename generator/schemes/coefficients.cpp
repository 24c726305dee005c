#include "generator/schemes/coefficients.hpp"

#include <algorithm>

#include "generator/base/diagnostic.hpp"

namespace hamgen {

Expression decimal(std::string_view digits) {
  const bool negative = digits.starts_with('-');
  if (negative) digits.remove_prefix(1);
  const auto value = parse_decimal(digits);
  if (!value) internal_error("not a decimal: " + std::string(digits));
  return Expression(negative ? Rational(-*value) : *value);
}

Coefficients decimals(std::initializer_list<std::string_view> digits) {
  Coefficients values;
  for (const std::string_view text : digits) values.push_back(decimal(text));
  return values;
}

Expression ratio(long numerator, long denominator) {
  Rational value(numerator, denominator);
  value.canonicalize();
  return Expression(value);
}

Coefficients palindrome(Coefficients half) {
  const Coefficients mirror(half.rbegin(), half.rend());
  const Expression sum = Expression::sum(half);
  half.push_back(Expression(1) - Expression(2) * sum);
  half.insert(half.end(), mirror.begin(), mirror.end());
  return half;
}

Coefficients even_palindrome(Coefficients half) {
  half.push_back(ratio(1, 2) - Expression::sum(half));
  const Coefficients mirror(half.rbegin(), half.rend());
  half.insert(half.end(), mirror.begin(), mirror.end());
  return half;
}

}  // namespace hamgen
