// How long formulas are once their definitions are put in.
#pragma once

#include <map>
#include <string>

#include "generator/language/ast.hpp"

namespace hamgen {

// Operators and calls of a formula with every definition written out where it is used, by the
// definitions' own counts; a sum counts once.  A double: thirty definitions that each use the one
// before twice make 2^30.
[[nodiscard]] double written_out_operations(const NodePtr& node,
                                            const std::map<std::string, double>& definitions);

}  // namespace hamgen
