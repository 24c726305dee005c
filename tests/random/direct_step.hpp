// A step by the equations of its scheme, solved by iterating them in quad: no plan, no Newton.
#pragma once

#include "generator/schemes/scheme.hpp"
#include "tests/random/direct.hpp"

namespace hamgen::random {

// Z of z.  Throws std::runtime_error where the iteration does not contract: steps are to be short.
[[nodiscard]] Vector direct_step(const DirectModel& model, const Scheme& scheme, Quad h,
                                 const Vector& z);

}  // namespace hamgen::random
