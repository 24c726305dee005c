// Numbers as languages spell them.
#pragma once

#include <string>

#include "generator/algebra/scalar.hpp"

namespace hamgen {

// A literal, or a quotient of literals, that gives the nearest number of the type.  Throws
// OutOfRange.
[[nodiscard]] std::string literal(const Rational& value, const ScalarType& scalar);

// What the library's functions of such numbers end in, in C: "f" of sinf, "l" of sinl.
[[nodiscard]] std::string function_suffix(const ScalarType& scalar);

}  // namespace hamgen
