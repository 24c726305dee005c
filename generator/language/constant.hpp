// Arithmetic on exact constants, with the reason where a value does not exist.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "generator/base/diagnostic.hpp"
#include "generator/language/ast.hpp"

namespace hamgen {

// An exponent that is a number lies between -largest_exponent and largest_exponent.
inline constexpr long largest_exponent = 1000;
// Squares of exact numbers have twice their digits: after 16 of them, as in parameters that are
// made of each other, a hundred thousand.
inline constexpr std::size_t most_digits = 20'000;

struct Undefined {
  std::string message;
  std::string help;
};
using Constant = std::variant<Rational, Undefined>;
// What is said of a number of more digits.
[[nodiscard]] Undefined too_long();

// Exact for rationals, else to 50 digits; Undefined where the value does not exist, is not real or
// is outside the range of a double.
[[nodiscard]] Constant combine(BinaryOperator operation, const Rational& left,
                               const Rational& right);
[[nodiscard]] Constant call_function(std::string_view function,
                                     std::span<const Rational> arguments);
// The mistake in a constant exponent, whatever its base.
[[nodiscard]] std::optional<Undefined> check_exponent(const Rational& exponent);

[[nodiscard]] const Rational& pi();
// The value of a name of the table of constants or "pi"; a short text for messages: "0.1", "1/3".
[[nodiscard]] std::string short_text(const Rational& value);

// A mistake in a constant, thrown by `evaluate`.
struct ConstantError {
  Diagnostic diagnostic;
};

// Value of a name with its subscript, if it has one; throws ConstantError if it has none.
using Lookup = std::function<Rational(const Node&, const NameNode&, const std::optional<long>&)>;

// The value of an expression whose names all have values.  Sums are added up, term by term.
[[nodiscard]] Rational evaluate(const NodePtr& node, const Lookup& lookup);
// The same, for an expression that must be an integer of at most 15 digits.
[[nodiscard]] long evaluate_integer(const NodePtr& node, const Lookup& lookup);

}  // namespace hamgen
