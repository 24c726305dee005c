// Is an expression identically zero?
#pragma once

#include "generator/algebra/expression.hpp"

namespace hamgen {

// Where it is refuted at a point or not decided within limits of size: false.  What is large but
// affine in the state, as the step of coupled oscillators, is decided at its unit points.
[[nodiscard]] bool is_zero_by_algebra(const Expression& e);

}  // namespace hamgen
