// Formulas for web pages, from the trees that hold them.
#pragma once

#include <string>

#include "app/output/math_formula.hpp"
#include "generator/algebra/expression.hpp"
#include "generator/language/ast.hpp"

namespace hamgen::app {

// As the user wrote it.
[[nodiscard]] MathFormula math_formula(const NodePtr& node);
// As to_text(expression) would be read.
[[nodiscard]] MathFormula math_formula(const Expression& expression);
// Of a variable or a parameter: "q[3]" has the subscript 3.
[[nodiscard]] MathFormula math_variable(const std::string& name);

}  // namespace hamgen::app
