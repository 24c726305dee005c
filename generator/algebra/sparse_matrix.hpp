// Matrices of expressions.
#pragma once

#include <map>
#include <utility>

#include "generator/algebra/expression.hpp"

namespace hamgen {

// The nonzero entries by (row, column), from 0.
using SparseMatrix = std::map<std::pair<int, int>, Expression>;

}  // namespace hamgen
