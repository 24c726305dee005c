// Numbers as languages spell them.
#pragma once

#include <string>

#include "generator/algebra/scalar.hpp"

namespace hamgen {

// A literal, or a quotient of literals, that gives the nearest number of the type.  Throws
// OutOfRange.
[[nodiscard]] std::string literal(const Rational& value, const ScalarType& scalar);

}  // namespace hamgen
