// One line of mathematics as it is typed in findings, read into the tree that pages are made from.
#pragma once

#include <string_view>

#include "app/output/math_formula.hpp"

namespace hamgen::app {

// Of "A+ J A+^T = 0", "f''(f,f)/24", "{I, H}", and of an expression's text.  Factors stand side by
// side with a space between them or a `*`; `A+` has the sign as its subscript, `f'` is a
// derivative, `grad` the nabla.  Of other text it makes what it can.
[[nodiscard]] MathFormula read_notation(std::string_view text);

}  // namespace hamgen::app
