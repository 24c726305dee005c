// What the energy error of a member of the family depends on to lowest order.
#pragma once

#include <vector>

#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// With C = h C1, a step follows to O(h^4) the flow of
//
//   H + h^2 [ (1/2) grad H^T C1 J grad H - (1/24) H''(J grad H, J grad H) ],
//
// so that H varies by h^2 times the variation of the bracket.  Returns first
// H''(J grad H, J grad H), then the n x n second derivatives by coordinates and those by momenta,
// row by row, then those by a coordinate and a momentum.  Needs sums that are written out.
[[nodiscard]] std::vector<NamedExpression> energy_curvature(const Mechanics& mechanics);

}  // namespace hamgen
