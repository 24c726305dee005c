// Checks what a formula computes with numbers: constants that exist, subscripts inside ranges.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "generator/language/symbols.hpp"

namespace hamgen {

// Values known when a model is read: sizes, and definitions that are constants.
using KnownValues = std::map<std::string, Rational>;

// Reports 1/0, log(-1), exponents out of range and subscripts outside an array.  The body of a sum
// is checked for the first and last three values of each index, which is enough for subscripts that
// are affine in the indices.  The names must have been checked.  Returns the value of a constant.
std::optional<Rational> check_values(const NodePtr& node, const KnownValues& known,
                                     Symbols& symbols);

}  // namespace hamgen
