// Formulas for web pages, from the trees that hold them.
#pragma once

#include <string>
#include <string_view>

#include "app/output/math_formula.hpp"
#include "generator/algebra/expression.hpp"
#include "generator/language/ast.hpp"

namespace hamgen::app {

// The expression as MathML, without the enclosing <math>: fractions, roots, powers and sums set as
// in print; "omega" is the Greek letter, "q1" and "q[1]" have a subscript.
[[nodiscard]] std::string math_markup(const NodePtr& node);
// As to_text(expression) would be read.
[[nodiscard]] std::string math_markup(const Expression& expression);
// A name alone, in the same way.
[[nodiscard]] std::string math_name(std::string_view name);

}  // namespace hamgen::app
