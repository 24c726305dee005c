// What a graph of expressions costs to evaluate.
#pragma once

#include <set>
#include <span>
#include <string>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// Additions, multiplications and divisions, a root counted as 10, a function as so many, shared
// nodes once.  What depends on no symbol of `varying` is computed beforehand and costs nothing.
[[nodiscard]] long operation_count(std::span<const Expression> values,
                                   const std::set<std::string>& varying, long function = 10);

}  // namespace hamgen
