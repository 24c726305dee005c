// Expressions as C++.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "generator/formats/scalar.hpp"
#include "generator/program/arithmetic.hpp"

namespace hamgen {

class CppExpression {
 public:
  using Namer = std::function<std::string(const std::string&)>;

  // With builtins, functions are the compiler's own (__builtin_sin), which need no header: reading
  // <cmath> takes three times as long as compiling a small plugin.
  CppExpression(const ScalarType& scalar, Namer namer, bool builtins = false)
      : scalar_(scalar), namer_(std::move(namer)), builtins_(builtins) {}

  // The expression as C++ with the fewest parentheses; notes the functions it calls.
  [[nodiscard]] std::string operator()(const Expression& e) const;
  // Functions of <cmath> used so far: they decide the includes.
  [[nodiscard]] const std::set<std::string>& functions() const { return functions_; }

 private:
  [[nodiscard]] std::string print(const Arithmetic& a, int context) const;
  [[nodiscard]] std::string call(const std::string& function, const std::string& arguments) const;

  const ScalarType& scalar_;
  Namer namer_;
  bool builtins_ = false;
  mutable std::set<std::string> functions_;
};

}  // namespace hamgen
