// Expressions for print.
#pragma once

#include <string>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// "\frac{p^{2}}{2} - \mathrm{eps} \cos q": Greek names as letters, q1 and q[1] with a subscript.
[[nodiscard]] std::string to_latex(const Expression& e);

}  // namespace hamgen
