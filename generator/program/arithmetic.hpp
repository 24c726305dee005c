// An expression as the operations a machine does, in the order it does them.  Formats print this
// tree and the interpreter runs it: both round in the same places.
#pragma once

#include <string>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// product_error(x, y) is what rounding takes from x y: zero in exact arithmetic, and no function of
// the language.
inline constexpr const char* kProductError = "product_error";

enum class Operation { number, symbol, negate, add, subtract, multiply, divide, call };

struct Arithmetic {
  Operation operation = Operation::number;
  Rational number;   // of a number, never negative
  std::string name;  // of a symbol; of the function that is called: "pow", "sqrt" and
                     // product_error too
  std::vector<Arithmetic> operands;  // one to negate, two of + - * /, the arguments of a call
};

// Sums begin with a positive term if there is one, products with their number; a power with an
// exponent up to 8 is a product, and all divisors of a product are multiplied before it is divided.
[[nodiscard]] Arithmetic arrange(const Expression& e);

}  // namespace hamgen
