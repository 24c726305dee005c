// Expressions made ready to be evaluated many times by the interpreter.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "generator/program/arithmetic.hpp"

namespace hamgen {

// The address of a number: objects[object][offset + sum of factor * indices[index]].  Of no object
// that place itself is the number.
inline constexpr int kIndex = -1;
struct Address {
  int object = 0;
  long offset = 0;
  std::vector<std::pair<int, long>> factors = {};
};

// Where the routine's numbers are while it runs.
template <class Real>
struct Frame {
  std::vector<Real*> objects;
  std::vector<long> indices;
  [[nodiscard]] long offset(const Address& address) const {
    long offset = address.offset;
    for (const auto& [index, factor] : address.factors) {
      offset += factor * indices[static_cast<std::size_t>(index)];
    }
    return offset;
  }
  // Of an object without numbers too, where there is nothing to point at.
  [[nodiscard]] Real* pointer(const Address& address) const {
    return objects[static_cast<std::size_t>(address.object)] + offset(address);
  }
  [[nodiscard]] Real& at(const Address& address) const { return *pointer(address); }
};

// A function of the language on numbers of the type, as <cmath> and <quadmath.h> have it, or as
// lanes of double numbers do.
template <class Real>
using NumericFunction = Real (*)(Real, Real);
enum class FunctionsOf { library, lanes };
// An internal error for a name that is none.
template <class Real>
[[nodiscard]] NumericFunction<Real> numeric_function(const std::string& name,
                                                     FunctionsOf functions = FunctionsOf::library);

// The nearest number of the type, ties to even.
template <class Real>
[[nodiscard]] Real nearest_number(const Rational& value);

// The operations of `arrange`, last operand first out.
template <class Real>
class CompiledExpression {
 public:
  using Resolve = std::function<Address(const std::string& symbol)>;
  CompiledExpression(const Expression& e, const Resolve& resolve,
                     FunctionsOf functions = FunctionsOf::library);
  [[nodiscard]] Real operator()(const Frame<Real>& frame) const;

 private:
  struct Step {
    Operation operation = Operation::number;
    Real number = 0;
    Address address = {};
    NumericFunction<Real> function = nullptr;
    bool two_arguments = false;
  };
  void add(const Arithmetic& a, const Resolve& resolve, FunctionsOf functions);
  std::vector<Step> steps_;
  mutable std::vector<Real> stack_;
};

}  // namespace hamgen
