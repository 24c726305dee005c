// What a machine computes, operation by operation: the text of a file and the expressions of a
// program are both brought into this form and compared.
//
// Equal means equal to the last bit, whatever the operands: the order of operations is kept, and
// only these are taken for one,
//   a b = b a,  a + b = b + a,  a - b = a + (-b),  (-a) b = -(a b),  (-a)/b = -(a/b),
// which IEEE 754 rounds alike.  -(a + b) and (-a) + (-b) differ in the sign of a zero.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generator/algebra/expression.hpp"
#include "generator/readback/precision.hpp"

namespace hamgen {

struct MachineValue {
  enum class Kind { number, symbol, sum, product, quotient, call };
  Kind kind = Kind::number;
  bool negative = false;
  Rational number = {};   // not negative
  std::string name = {};  // of a symbol or what is called
  std::vector<MachineValue> parts = {};
};

[[nodiscard]] MachineValue machine_symbol(std::string name);
[[nodiscard]] MachineValue machine_call(std::string name, std::vector<MachineValue> arguments);
[[nodiscard]] MachineValue operator-(MachineValue a);
[[nodiscard]] MachineValue operator+(MachineValue a, MachineValue b);
[[nodiscard]] MachineValue operator*(MachineValue a, MachineValue b);
[[nodiscard]] MachineValue operator/(MachineValue a, MachineValue b);

// The operations for an expression, whose symbols are called as `name` says.
[[nodiscard]] MachineValue machine_value(
    const Expression& e, const std::function<std::string(const std::string&)>& name);

// `written` has numbers as they are read, `exact` as they are meant.
[[nodiscard]] bool is_same(const MachineValue& written, const MachineValue& exact,
                           const Precision& precision);

// Do the operations that are done for the expression compute it, but for rounding?
[[nodiscard]] bool is_computed_as_meant(const Expression& e);

}  // namespace hamgen
