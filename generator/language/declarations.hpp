// Declarations with their integers computed: sizes, ranges, values beyond the ends of an array.
#pragma once

#include <map>
#include <string>

#include "generator/language/check_values.hpp"
#include "generator/language/model.hpp"
#include "generator/language/symbols.hpp"
#include "generator/language/syntax.hpp"

namespace hamgen {

inline constexpr long largest_array = 10'000'000;
inline constexpr long largest_count = 100'000'000;  // of a size, an end of a range, a subscript

// Fills sizes, coordinates, momenta and parameters of the model, the symbols, and the known values.
// `overrides` replaces the values of sizes.
void declare_all(const Syntax& syntax, const std::map<std::string, long>& overrides, Model& model,
                 Symbols& symbols, KnownValues& known);

}  // namespace hamgen
