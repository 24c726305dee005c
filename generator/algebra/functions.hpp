// THE TABLE of functions the language knows.  To add a function, add one row in functions.cpp; an
// example is in docs/extending.md.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "generator/algebra/exact.hpp"

namespace hamgen {

class Expression;

// A function on the numbers of each scalar, as <cmath> and <quadmath.h> have it; of one argument it
// takes no notice of the second.
struct NumericValues {
  __extension__ typedef __float128 Quad;
  float (*single)(float, float);
  double (*real)(double, double);
  long double (*extended)(long double, long double);
  Quad (*quad)(Quad, Quad);
};

// What f(-x) is.
enum class Parity { none, odd, even };
// How it goes where it is defined: what encloses it on an interval.
enum class Shape { unknown, ascending, descending, valley_at_zero, sine, cosine, tangent };

struct Function {
  std::string_view name;  // in the language, and in GiNaC where that knows it
  int arity = 1;
  std::string_view cpp;   // in <cmath>, without std::
  std::string_view quad;  // in <quadmath.h>; empty for those written as a power
  NumericValues numbers;
  std::string_view description;  // one line for `hamgen list functions`
  std::string_view domain;       // where it is defined, "all x" or a condition
  // Is there none where all its arguments are 0, whatever a library returns?
  bool is_undefined_at_zero = false;
  // Has it derivatives of every order for all x?
  bool is_smooth = false;
  // Has it a power series where an argument is 0?  Neither a corner, nor a pole, nor a cut.
  bool analytic_at_zero = true;
  // Where it bends or jumps though it is defined, "{0} = 0" for its first argument; or nothing.
  std::string_view corner = {};
  Parity parity = Parity::none;
  Shape shape = Shape::unknown;
  // The rational number at which its value is a rational one, of those without further ones.
  std::optional<int> exact_at = {};
  // Does it go as exp(|x|) does, or to a limit by as little?
  bool is_exponential = false;
  // f^2 = sign (1 - g^2) with the function g: of sin and sinh.
  std::string_view square_partner = {};
  int square_sign = 1;
  bool has_latex_name = false;  // \sin
  using Formula = Expression (*)(std::span<const Expression> arguments);
  // The derivatives by its arguments: what power series and bounds of rounding follow from.
  std::array<Formula, 2> slopes = {};
  // Of a function of one argument that GiNaC does not know: its value by others.
  Formula by_others = nullptr;
};

// All functions in alphabetical order.
[[nodiscard]] std::span<const Function> all_functions();
[[nodiscard]] const Function* find_function(std::string_view name);

// The value of a function of the table (or of "pi" without arguments) at exact arguments, to 50
// digits; exact where the result is a rational the arguments show (sqrt(4), sin(0)), or
// they are multiples of pi (cos(pi/2)).
// Empty where the function is not defined or not real.
[[nodiscard]] std::optional<Rational> evaluate_function(std::string_view name,
                                                        std::span<const Rational> arguments);
// base^exponent for a general exponent, to 50 digits; empty where it is undefined, not real, or
// too large.
[[nodiscard]] std::optional<Rational> evaluate_power(const Rational& base,
                                                     const Rational& exponent);

}  // namespace hamgen
