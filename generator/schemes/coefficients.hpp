// How the tables of schemes are written.
#pragma once

#include <initializer_list>
#include <string_view>
#include <vector>

#include "generator/schemes/scheme.hpp"

namespace hamgen {

using Coefficients = std::vector<Expression>;

// "0.2844..." exactly as it stands; a leading '-' is allowed.
[[nodiscard]] Expression decimal(std::string_view digits);
[[nodiscard]] Coefficients decimals(std::initializer_list<std::string_view> digits);
[[nodiscard]] Expression ratio(long numerator, long denominator);

// half_1, ..., half_k, 1 - 2 sum, half_k, ..., half_1: sums to 1.
[[nodiscard]] Coefficients palindrome(Coefficients half);
// half_1, ..., half_k, last, last, half_k, ..., half_1 with last = 1/2 - sum.
[[nodiscard]] Coefficients even_palindrome(Coefficients half);

// Its own adjoint: kicks and drifts are the same in reverse.
[[nodiscard]] bool is_symmetric(const Splitting& method);

}  // namespace hamgen
