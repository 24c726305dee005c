// Derivatives of expressions as graphs: shared subexpressions stay shared.
#pragma once

#include <span>
#include <vector>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// de/dx for every symbol x of `variables`.  The derivatives are accumulated from the result towards
// the symbols, so that all of them together cost a small multiple of e, however many there are.
[[nodiscard]] std::vector<Expression> gradient(const Expression& e,
                                               std::span<const Expression> variables);
[[nodiscard]] Expression derivative(const Expression& e, const Expression& variable);

// The derivative of a function of the table by its k-th argument, at the arguments of `call`.
[[nodiscard]] Expression partial_derivative(const Expression& call, std::size_t k);

}  // namespace hamgen
