// Functions of the step as power series.
#pragma once

#include <optional>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// The coefficients of h^0, h^1, ... of an expression at h = 0, where they may exist as limits only:
// 1/tan(h) - 1/h.  Empty if there is no such series, or none could be found.
[[nodiscard]] std::optional<std::vector<Expression>> step_series(const Expression& e, int count);

// Is there an absolute value, a logarithm or a root at h = 0 of what vanishes there: sqrt(abs(h)),
// abs(sin(h)), h log(h)?
[[nodiscard]] bool has_corner(const Expression& e);

}  // namespace hamgen
