// tangent(par, h, z, dz, m): M = dZ/dz of the step that moves z by dz.
#pragma once

#include <string>

#include "generator/program/environment.hpp"
#include "generator/program/linearisation.hpp"

namespace hamgen {

// Of a member that is solved.  False if the linearised equations have no finite solution.  `large`
// matrices are left to Eigen.
[[nodiscard]] Routine tangent_routine(const Environment& environment, std::string name,
                                      const Linearisation& linearisation, bool large);

}  // namespace hamgen
