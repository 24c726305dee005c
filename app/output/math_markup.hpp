// Formulas for web pages.
#pragma once

#include <string>
#include <string_view>

#include "generator/language/ast.hpp"

namespace hamgen::app {

// The expression as MathML, without the enclosing <math>: fractions, roots, powers and sums set as
// in print; "omega" is the Greek letter, "q1" and "q[1]" have a subscript.
[[nodiscard]] std::string math_markup(const NodePtr& node);
// A name alone, in the same way.
[[nodiscard]] std::string math_name(std::string_view name);

// Text with the characters that mean something in HTML replaced.
[[nodiscard]] std::string html_text(std::string_view text);

}  // namespace hamgen::app
