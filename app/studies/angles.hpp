// Which coordinates of a model are angles.
#pragma once

#include <vector>

#include "runtime/integrator.hpp"
#include "runtime/library.hpp"

namespace hamgen::app {

// For each of n coordinates: is H the same after a turn of 2 pi, to rounding, and not after a part
// of one, at points around the start as far away as `sizes` say (2n natural sizes)?  One that H
// does not depend on may be a length as well, and counts as none.
[[nodiscard]] std::vector<bool> angles(const runtime::Library& library,
                                       const runtime::InitialValues& start,
                                       const std::vector<double>& sizes);

// The same angle from -pi to pi.
[[nodiscard]] double within_a_turn(double angle);

}  // namespace hamgen::app
