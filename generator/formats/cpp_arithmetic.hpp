// What an emitted file demands of the compiler's arithmetic: every operation rounded as IEEE 754
// says.  The compensated sums compute what rounding lost, (a + b) - a - b, which is 0 to a compiler
// that may reorder sums.
#pragma once

#include "generator/formats/code_writer.hpp"
#include "generator/formats/scalar.hpp"

namespace hamgen {

// Between the includes and the code: an error with -ffast-math, -Ofast and those of their parts
// that the compiler has a macro for.  Clang has none for -fassociative-math, but can be told to
// keep the order of sums from here on.
void begin_ieee_arithmetic(CodeWriter& out, const ScalarType& scalar);

// After the code the includer's own flags hold again.
void end_ieee_arithmetic(CodeWriter& out);

}  // namespace hamgen
