// In what units an orbit's coordinates and momenta are numbers near one.
#pragma once

#include <vector>

#include "runtime/integrator.hpp"
#include "runtime/library.hpp"

namespace hamgen::app {

// For each component of the state (2n values: q then p) the least power of two by which it can be
// changed, up or down, so that H changes by a quarter of `energy`, which its terms are at the
// start; of one on which H does not depend so much the largest of its kind, else 1.  From 1/64 to
// 64 they are 1: so are those of a model in units that suit it.
[[nodiscard]] std::vector<double> natural_sizes(const runtime::Library& library,
                                                const runtime::InitialValues& start, double energy);

}  // namespace hamgen::app
