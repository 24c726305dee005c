// The number an expression is when its symbols have values.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "generator/algebra/expression.hpp"

namespace hamgen {

using Values = std::map<std::string, Rational>;

// Exact for rational functions, else to 50 digits; empty where it is undefined or not real, and
// where a symbol (other than pi) has no value.
[[nodiscard]] std::optional<Rational> evaluate(const Expression& e, const Values& values);

}  // namespace hamgen
