// How the numbers of a scalar round, and how their literals are read.
#pragma once

#include <optional>
#include <string_view>

#include "generator/algebra/exact.hpp"

namespace hamgen {

struct Precision {
  std::string_view scalar;   // on the command line
  std::string_view type;     // in C++
  std::string_view space;    // the namespace of the fixed blocks
  int bits = 53;             // of the mantissa
  int low = -1074;           // numbers are multiples of 2^low
  std::string_view suffix;   // of literals
  std::string_view largest;  // what is beyond counts as infinite
  [[nodiscard]] bool is_quad() const { return bits == 113; }
};

// "" is double.  An internal error for a name that is none.
[[nodiscard]] const Precision& precision_of(std::string_view scalar);

// The nearest number of so many bits, of two equally near ones the even one.
[[nodiscard]] Rational rounded(const Rational& value, int bits, int low);
[[nodiscard]] Rational rounded(const Rational& value, const Precision& precision);

// A literal of C++ as it is read: the nearest number of its own type.
struct CppLiteral {
  Rational value;
  bool is_integer = false;
  int bits = 53;
};
[[nodiscard]] std::optional<CppLiteral> read_literal(std::string_view text);

// Is the first the number that the second is rounded to?  In more than double precision numbers are
// written as sums of three doubles, which may round twice: within 2^-20 of half a last place.
[[nodiscard]] bool is_rounded(const Rational& written, const Rational& exact,
                              const Precision& precision);

}  // namespace hamgen
