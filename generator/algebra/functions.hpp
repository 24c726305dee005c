// THE TABLE of functions the language knows.  To add a function, add one row in functions.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "generator/algebra/exact.hpp"

namespace hamgen {

struct Function {
  std::string_view name;  // in the language, and in GiNaC where the two agree
  int arity = 1;
  std::string_view cpp;          // in <cmath>, without std::
  std::string_view quad;         // in <quadmath.h>; empty for those written as a power
  std::string_view description;  // one line for `hamgen list functions`
  std::string_view domain;       // where it is defined, "all x" or a condition
  // Has it a power series where an argument is 0?  Neither a corner, nor a pole, nor a cut.
  bool analytic_at_zero = true;
};

// All functions in alphabetical order.
[[nodiscard]] std::span<const Function> all_functions();
[[nodiscard]] const Function* find_function(std::string_view name);

// The value of a function of the table (or of "pi" without arguments) at exact arguments, to 50
// digits; exact where the result is a rational the arguments show (sqrt(4), sin(0)).
// Empty where the function is not defined or not real.
[[nodiscard]] std::optional<Rational> evaluate_function(std::string_view name,
                                                        std::span<const Rational> arguments);
// base^exponent for a general exponent, to 50 digits; empty where it is undefined, not real, or
// too large.
[[nodiscard]] std::optional<Rational> evaluate_power(const Rational& base,
                                                     const Rational& exponent);

}  // namespace hamgen
