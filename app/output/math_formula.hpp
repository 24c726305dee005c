// Formulas for web pages: MathML put together from its parts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hamgen::app {

// How tightly a formula holds together, as in the language's own notation.
enum class Tightness { sum, product, sign, power, atom };

struct MathFormula {
  std::string markup;  // without the enclosing <math>
  Tightness tightness = Tightness::atom;
  bool is_number = false;  // written as one
  bool is_call = false;    // of a function
  std::string function;    // of one argument, named before it: a power follows the name
  std::string argument;    // of that function
  std::string in_line;     // numbers above one another, as an exponent has them beside one another
};

[[nodiscard]] MathFormula math_number(const std::string& text);
// "omega" is the Greek letter, "q1" has a subscript.
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

// sum(index = lower..upper, ...), ranges from the outermost to the innermost.
struct MathRange {
  std::string index;
  MathFormula lower, upper;
};
[[nodiscard]] MathFormula sum_over(const std::vector<MathRange>& ranges, const MathFormula& body);

}  // namespace hamgen::app
