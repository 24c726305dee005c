// For which h do the powers of a linear step stay bounded, by intervals of h?
#pragma once

#include "generator/verify/stable_steps.hpp"

namespace hamgen {

// As stable_steps, of a member whose C is no rational function of h, or is too long for it:
// intervals of h up to 100 over the fastest frequency `w` are halved until the enclosures of q(s)
// say that all its roots are real, different and between -2 and 2, or that they are not, or until
// they are as short as 1e-6 of h.  Below 1/100 over w the step is taken for bounded, as the flow
// is.  The search ends where an h remains open; empty if that is at once, as with frequencies that
// are equal for every h.
[[nodiscard]] std::optional<StableSteps> enclosed_steps(
    const Scheme& scheme, const std::map<std::string, Rational>& values, const ExactMatrix& s,
    int free_motions, double w);

}  // namespace hamgen
