// The end of a fixed-point iteration, below the last place of its unknowns.
#pragma once

#include <string>

#include "generator/formats/scalar.hpp"

namespace hamgen {

// Note [below the last place]
// A fixed-point iteration ends at numbers that its rounded map takes to themselves.  Of two such
// neighbours it ends at the one on the side it came from, and that is the same step after step: a
// bias of the solution, of some thousandths of a unit of rounding times the contraction, and a
// drift. What the equations lack at that point is known without an error, though: it is small. Over
// so small a distance they are linear, and the change of the gradient along it is a difference over
// one that is 2^15 times as long, divided by as much.
//
// struct Refinement<Size, Components>, by reverse communication: call it with the point, what the
// equations lack there and the gradient, and evaluate both at the point it gives back, as long as
// it returns true.  Its `change` is what the gradient lacks then.  Multiplied by the inverse of a
// matrix, what the equations lack makes a simplified Newton iteration of it.
[[nodiscard]] std::string cpp_refinement(const ScalarType& scalar);
[[nodiscard]] std::string refinement_remark();
// A power of two near epsilon^(-3/10): what is not linear, and what a difference loses, are both
// far below a unit of rounding.
[[nodiscard]] long refinement_amplifier(const ScalarType& scalar);

}  // namespace hamgen
