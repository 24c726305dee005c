#include "generator/algebra/functions.hpp"

#include <quadmath.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "generator/algebra/expression.hpp"

namespace hamgen {
namespace {

using X = std::span<const Expression>;
using Quad = NumericValues::Quad;

Expression call(const char* function, X x) { return Expression::apply(function, {x[0]}); }
Expression square(const Expression& x) { return Expression::power(x, 2); }
Expression inverse_root(const Expression& x) { return Expression::power(x, Rational(-1, 2)); }
Expression inverse(const Expression& x) { return Expression::power(x, -1); }

// The function of <cmath> and <quadmath.h> of that name.
#define HAMGEN_LIBRARY(function)                                           \
  .cpp = #function, .quad = #function "q",                                 \
  .numbers = {[](float x, float) -> float { return std::function(x); },    \
              [](double x, double) { return std::function(x); },           \
              [](long double x, long double) { return std::function(x); }, \
              [](Quad x, Quad) -> Quad { return function##q(x); }}
#define HAMGEN_LIBRARY_OF_TWO(function)                                         \
  .cpp = #function, .quad = #function "q",                                      \
  .numbers = {[](float x, float y) -> float { return std::function(x, y); },    \
              [](double x, double y) { return std::function(x, y); },           \
              [](long double x, long double y) { return std::function(x, y); }, \
              [](Quad x, Quad y) -> Quad { return function##q(x, y); }}

const Function table[] = {
    {.name = "abs",
     HAMGEN_LIBRARY(fabs),
     .description = "absolute value, derivative x/abs(x)",
     .domain = "all x",
     .analytic_at_zero = false,
     .corner = "{0} = 0",
     .parity = Parity::even,
     .shape = Shape::valley_at_zero,
     .slopes = {[](X x) { return x[0] * inverse(call("abs", x)); }}},
    {.name = "acos",
     HAMGEN_LIBRARY(acos),
     .description = "arc cosine",
     .domain = "-1 <= x <= 1",
     .shape = Shape::descending,
     .exact_at = 1,
     .slopes = {[](X x) { return -inverse_root(1 - square(x[0])); }}},
    {.name = "acosh",
     HAMGEN_LIBRARY(acosh),
     .description = "inverse hyperbolic cosine",
     .domain = "x >= 1",
     .analytic_at_zero = false,
     .shape = Shape::ascending,
     .exact_at = 1,
     .slopes = {[](X x) { return inverse_root(square(x[0]) - 1); }}},
    {.name = "asin",
     HAMGEN_LIBRARY(asin),
     .description = "arc sine",
     .domain = "-1 <= x <= 1",
     .parity = Parity::odd,
     .shape = Shape::ascending,
     .exact_at = 0,
     .slopes = {[](X x) { return inverse_root(1 - square(x[0])); }}},
    {.name = "asinh",
     HAMGEN_LIBRARY(asinh),
     .description = "inverse hyperbolic sine",
     .domain = "all x",
     .is_smooth = true,
     .parity = Parity::odd,
     .shape = Shape::ascending,
     .exact_at = 0,
     .slopes = {[](X x) { return inverse_root(1 + square(x[0])); }}},
    {.name = "atan",
     HAMGEN_LIBRARY(atan),
     .description = "arc tangent",
     .domain = "all x",
     .is_smooth = true,
     .parity = Parity::odd,
     .shape = Shape::ascending,
     .exact_at = 0,
     .slopes = {[](X x) { return inverse(1 + square(x[0])); }}},
    {.name = "atan2",
     .arity = 2,
     HAMGEN_LIBRARY_OF_TWO(atan2),
     .description = "angle of the point (x, y), written atan2(y, x)",
     .domain = "(x, y) other than (0, 0)",
     .is_undefined_at_zero = true,
     .analytic_at_zero = false,
     .corner = "{0} = 0 and {1} < 0",
     .slopes = {[](X yx) { return yx[1] * inverse(square(yx[0]) + square(yx[1])); },
                [](X yx) { return -yx[0] * inverse(square(yx[0]) + square(yx[1])); }}},
    {.name = "atanh",
     HAMGEN_LIBRARY(atanh),
     .description = "inverse hyperbolic tangent",
     .domain = "-1 < x < 1",
     .parity = Parity::odd,
     .shape = Shape::ascending,
     .exact_at = 0,
     .slopes = {[](X x) { return inverse(1 - square(x[0])); }}},
    {.name = "cos",
     HAMGEN_LIBRARY(cos),
     .description = "cosine",
     .domain = "all x",
     .is_smooth = true,
     .parity = Parity::even,
     .shape = Shape::cosine,
     .exact_at = 0,
     .has_latex_name = true,
     .slopes = {[](X x) { return -call("sin", x); }}},
    {.name = "cosh",
     HAMGEN_LIBRARY(cosh),
     .description = "hyperbolic cosine",
     .domain = "all x",
     .is_smooth = true,
     .parity = Parity::even,
     .shape = Shape::valley_at_zero,
     .exact_at = 0,
     .is_exponential = true,
     .has_latex_name = true,
     .slopes = {[](X x) { return call("sinh", x); }}},
    {.name = "exp",
     HAMGEN_LIBRARY(exp),
     .description = "exponential",
     .domain = "all x",
     .is_smooth = true,
     .shape = Shape::ascending,
     .exact_at = 0,
     .is_exponential = true,
     .has_latex_name = true,
     .slopes = {[](X x) { return call("exp", x); }}},
    {.name = "expm1",
     HAMGEN_LIBRARY(expm1),
     .description = "exp(x) - 1, exact near x = 0 too",
     .domain = "all x",
     .is_smooth = true,
     .shape = Shape::ascending,
     .exact_at = 0,
     .is_exponential = true,
     .slopes = {[](X x) { return call("exp", x); }},
     .by_others = [](X x) { return call("exp", x) - 1; }},
    {.name = "log",
     HAMGEN_LIBRARY(log),
     .description = "natural logarithm",
     .domain = "x > 0",
     .analytic_at_zero = false,
     .shape = Shape::ascending,
     .exact_at = 1,
     .has_latex_name = true,
     .slopes = {[](X x) { return inverse(x[0]); }}},
    {.name = "log1p",
     HAMGEN_LIBRARY(log1p),
     .description = "log(1 + x), exact near x = 0 too",
     .domain = "x > -1",
     .shape = Shape::ascending,
     .exact_at = 0,
     .slopes = {[](X x) { return inverse(1 + x[0]); }},
     .by_others = [](X x) { return Expression::apply("log", {1 + x[0]}); }},
    {.name = "sin",
     HAMGEN_LIBRARY(sin),
     .description = "sine",
     .domain = "all x",
     .is_smooth = true,
     .parity = Parity::odd,
     .shape = Shape::sine,
     .exact_at = 0,
     .square_partner = "cos",
     .has_latex_name = true,
     .slopes = {[](X x) { return call("cos", x); }}},
    {.name = "sinh",
     HAMGEN_LIBRARY(sinh),
     .description = "hyperbolic sine",
     .domain = "all x",
     .is_smooth = true,
     .parity = Parity::odd,
     .shape = Shape::ascending,
     .exact_at = 0,
     .is_exponential = true,
     .square_partner = "cosh",
     .square_sign = -1,
     .has_latex_name = true,
     .slopes = {[](X x) { return call("cosh", x); }}},
    {.name = "sqrt",
     HAMGEN_LIBRARY(sqrt),
     .description = "square root",
     .domain = "x >= 0",
     .analytic_at_zero = false,
     .shape = Shape::ascending,
     .has_latex_name = true,
     .slopes = {[](X x) { return Rational(1, 2) * inverse_root(x[0]); }}},
    {.name = "tan",
     HAMGEN_LIBRARY(tan),
     .description = "tangent",
     .domain = "x other than odd multiples of pi/2",
     .parity = Parity::odd,
     .shape = Shape::tangent,
     .exact_at = 0,
     .has_latex_name = true,
     .slopes = {[](X x) { return 1 + square(call("tan", x)); }}},
    {.name = "tanh",
     HAMGEN_LIBRARY(tanh),
     .description = "hyperbolic tangent",
     .domain = "all x",
     .is_smooth = true,
     .parity = Parity::odd,
     .shape = Shape::ascending,
     .exact_at = 0,
     .is_exponential = true,
     .has_latex_name = true,
     .slopes = {[](X x) { return 1 - square(call("tanh", x)); }}},
};

#undef HAMGEN_LIBRARY
#undef HAMGEN_LIBRARY_OF_TWO

}  // namespace

std::span<const Function> all_functions() { return table; }

const Function* find_function(std::string_view name) {
  const auto* row = std::ranges::find(table, name, &Function::name);
  return row == std::end(table) ? nullptr : row;
}

}  // namespace hamgen
