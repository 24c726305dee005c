// The parts of an emitted file that do not depend on the mathematics: the headers of
// generator/numerics, letter by letter, and the names that they are given.
//
// A header there is tested as it is (tests/numerics_blocks), includes nothing and has no guard, for
// it stands in the namespace that defines its vocabulary:
//   Real       a floating-point type
//   magnitude  its absolute value
//   largest    close to its largest number: what is not <= largest is infinite or not a number
//   epsilon    the distance from 1 to the next number
// Sizes are template parameters.  Those in shells/ stand around a step and use more of its names.
#pragma once

#include <string>
#include <string_view>

#include "generator/base/numerics_text.hpp"
#include "generator/formats/literal.hpp"

namespace hamgen {

// The vocabulary but for Real; |x| by the compiler's own function where no header is wanted.
[[nodiscard]] std::string cpp_vocabulary(const ScalarType& scalar, bool builtins);

// Real, Mask and the vocabulary of packs of so many numbers.
[[nodiscard]] std::string lanes_vocabulary(const ScalarType& scalar, int lanes);

// What is demanded of the compiler's arithmetic, between the includes and the code and up to the
// text "shells/ieee_end": every operation rounded as IEEE 754 says.  The compensated sums compute
// what rounding lost, (a + b) - a - b, which is 0 to a compiler that may reorder sums.
[[nodiscard]] std::string ieee_begin(const ScalarType& scalar);

// The text of generator/numerics/NAME.hpp.
[[nodiscard]] std::string cpp_numerics(std::string_view name);
// That of a block in C, or what is made for the scalar, with the function |x|.
[[nodiscard]] std::string c_numerics(std::string_view name, const ScalarType& scalar,
                                     const std::string& fabs);

}  // namespace hamgen
