// In what units an orbit's coordinates and momenta are numbers near one.
#pragma once

#include <vector>

#include "runtime/integrator.hpp"
#include "runtime/library.hpp"

namespace hamgen::app {

// For each component of the state (2n values: q then p) the least power of two by which it can be
// changed, up or down, so that H changes by a quarter of `energy`, which moves the orbit at its
// start.  Where H does not depend on one as much, it is the action of the pair that has the
// largest, over the size of its partner: an angle is no length.  From 1/64 to 64 sizes are 1: so
// are those of a model in units that suit it; and all are where nothing moves.
[[nodiscard]] std::vector<double> natural_sizes(const runtime::Library& library,
                                                const runtime::InitialValues& start, double energy);
// By the larger of |q H_q|/2 and |p H_p|/2 at the start, in which constants of H have no part.
[[nodiscard]] std::vector<double> natural_sizes(const runtime::Library& library,
                                                const runtime::InitialValues& start);

}  // namespace hamgen::app
