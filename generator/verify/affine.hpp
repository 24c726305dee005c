// Expressions that are affine in some of their symbols.
#pragma once

#include <string>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// Symbols in which the expression, as it is written, is affine: in all of them together, so that it
// is zero if it vanishes where all of them are 0 and where one is 1 and the others 0.  Of several
// such sets one.
[[nodiscard]] std::vector<std::string> affine_symbols(const Expression& e);

// The expression at these points.
[[nodiscard]] std::vector<Expression> at_unit_points(const Expression& e,
                                                     const std::vector<std::string>& affine);

}  // namespace hamgen
