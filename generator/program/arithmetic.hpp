// An expression as the operations a machine does, in the order it does them.  Formats print this
// tree and the interpreter runs it: both round in the same places.
#pragma once

#include <string>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// What rounding takes from x y and from x - y: zero in exact arithmetic, and no functions of the
// language.
inline constexpr const char* kProductError = "product_error";
inline constexpr const char* kDifferenceError = "difference_error";
[[nodiscard]] inline bool is_rounding_error(const std::string& function) {
  return function == kProductError || function == kDifferenceError;
}

// 1 or 1/2, with either sign: a product with it has no error.
[[nodiscard]] bool multiplies_exactly(const Expression& factor);

enum class Operation { number, symbol, negate, add, subtract, multiply, divide, call };

struct Arithmetic {
  Operation operation = Operation::number;
  Rational number;   // of a number, never negative
  std::string name;  // of a symbol; of the function that is called: "pow", "sqrt" and
                     // those above too
  std::vector<Arithmetic> operands;  // one to negate, two of + - * /, the arguments of a call
};

// Sums begin with a positive term if there is one, products with their number; a power with an
// exponent up to 8 is a product, and all divisors of a product are multiplied before it is divided.
[[nodiscard]] Arithmetic arrange(const Expression& e);

}  // namespace hamgen
