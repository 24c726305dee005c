// The floating-point scalars a program can be written in.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "generator/algebra/exact.hpp"

namespace hamgen {

struct ScalarType {
  std::string_view name;     // on the command line
  std::string_view cpp;      // its C++ type
  int digits = 53;           // of the binary mantissa
  std::string_view suffix;   // of literals
  std::string_view epsilon;  // 2^(1 - digits) as a literal
  std::string_view largest;  // a literal close to the largest finite number
};

[[nodiscard]] std::span<const ScalarType> all_scalars();
// Throws UsageError, naming those there are.  "" is double.
[[nodiscard]] const ScalarType& find_scalar(std::string_view name);

// A literal, or a quotient of literals, that gives the nearest number of the type.
[[nodiscard]] std::string literal(const Rational& value, const ScalarType& scalar);

}  // namespace hamgen
