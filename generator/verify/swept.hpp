// A fixed number of sweeps in place of the solution of the step's equations.
#pragma once

#include "generator/mechanics/mechanics.hpp"
#include "generator/schemes/scheme.hpp"
#include "generator/verify/derivatives.hpp"

namespace hamgen {

// Is the step after so many sweeps that of the solved equations, by algebra?  False also where
// algebra does not see it.
[[nodiscard]] bool sweeps_solve(const Mechanics& mechanics, const Derivatives& derivatives,
                                const Member& member, int sweeps);

}  // namespace hamgen
