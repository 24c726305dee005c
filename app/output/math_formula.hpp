// Formulas for web pages: what is written, as a tree, and the MathML that shows it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hamgen::app {

enum class MathKind {
  number,
  symbol,
  mark,  // what stands beside letters: a sign, primes, "T" of a transpose, dots
  negation,
  sum,
  product,
  quotient,
  power,
  call,
  application,  // of a function that is no name: a derivative
  brackets,
  relation,
  big_sum
};

// Built by the functions below, which bring a sign in front of products and quotients, and
// quotients of quotients under one bar.
struct MathFormula {
  MathKind kind = MathKind::number;
  // Digits; name of a symbol, a function or an index; the mark; "()" or "{}"; signs of relation.
  std::string text;
  // Operands; of a symbol its subscripts; of an application first the function; of a big sum the
  // lower and the upper end and the body.
  std::vector<MathFormula> parts;
};

[[nodiscard]] MathFormula math_number(const std::string& text);
// Rounded to so many digits, with a power of ten where plain_number has one.
[[nodiscard]] MathFormula math_value(double value, int digits);
// "omega" is the Greek letter; "q1", "px", "rc", "v_max" have a subscript.
[[nodiscard]] MathFormula math_symbol(std::string_view name);
[[nodiscard]] MathFormula with_subscript(std::string_view name, const MathFormula& subscript);
[[nodiscard]] MathFormula negated(const MathFormula& operand);
[[nodiscard]] MathFormula sum_of(const MathFormula& left, const MathFormula& right);
[[nodiscard]] MathFormula difference_of(const MathFormula& left, const MathFormula& right);
[[nodiscard]] MathFormula product_of(const MathFormula& left, const MathFormula& right);
[[nodiscard]] MathFormula quotient_of(const MathFormula& above, const MathFormula& below);
[[nodiscard]] MathFormula power_of(const MathFormula& base, const MathFormula& exponent);
[[nodiscard]] MathFormula call_of(const std::string& function,
                                  const std::vector<MathFormula>& arguments);
[[nodiscard]] MathFormula math_mark(const std::string& text);
[[nodiscard]] MathFormula applied(const MathFormula& function,
                                  const std::vector<MathFormula>& arguments);
[[nodiscard]] MathFormula in_brackets(const std::string& both,
                                      const std::vector<MathFormula>& list);
// A sign of '=', '<', '>', ',' between each two of the parts; of one part the part itself.
[[nodiscard]] MathFormula related(const std::string& signs, const std::vector<MathFormula>& parts);
// sum(index = lower..upper, body).
[[nodiscard]] MathFormula sum_over(const std::string& index, const MathFormula& lower,
                                   const MathFormula& upper, const MathFormula& body);

[[nodiscard]] bool is_negation(const MathFormula& formula);
// Of a product, or the formula itself; and back.
[[nodiscard]] std::span<const MathFormula> factors_of(const MathFormula& formula);
[[nodiscard]] MathFormula product_of_all(std::vector<MathFormula> factors);

// MathML without the enclosing <math>: fractions, roots, powers and sums set as in print, with no
// fraction's bar inside another fraction.
[[nodiscard]] std::string math_markup(const MathFormula& formula);
// The same in parts between which a line may end: the terms of a sum, each with its sign.
[[nodiscard]] std::vector<std::string> math_pieces(const MathFormula& formula);
// The same with slashes for bars, as high as a line of text.
[[nodiscard]] std::string line_markup(const MathFormula& formula);
// That in parts between which a line may end: before the signs of a relation.
[[nodiscard]] std::vector<std::string> line_pieces(const MathFormula& formula);
// A symbol with a sign above it: "˙" of its derivative by time.
[[nodiscard]] std::string accented_markup(const MathFormula& symbol, std::string_view accent);

}  // namespace hamgen::app
