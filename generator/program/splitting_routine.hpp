// The routines of a splitting: dV/dq, dT/dp, and solve(par, k, z, carry, start, dz), which kicks
// and drifts in turn.
#pragma once

#include <vector>

#include "generator/program/coefficients.hpp"

namespace hamgen {

// kick and drift, as multiples of h.
[[nodiscard]] std::vector<ScaledNumbers> splitting_lengths(const Sequence& sequence);

// Does it end with a substep of the kind it begins with?
[[nodiscard]] bool is_closed(const Sequence& sequence);
// Then the gradient that the last one takes serves the first one of the next step, and is kept in
// start, unless it is one of velocities that are taken where the momenta are.
[[nodiscard]] bool keeps_gradient(const LoweredStep& lowered);

[[nodiscard]] std::vector<Routine> splitting_routines(const Environment& environment,
                                                      const LoweredStep& lowered,
                                                      const Coefficients& coefficients);

}  // namespace hamgen
