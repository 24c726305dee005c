// A linear step taken apart into degrees of freedom that do not know of each other, and what the
// powers of a part do.
#pragma once

#include <vector>

#include "generator/verify/bounded_powers.hpp"
#include "generator/verify/rational_step.hpp"

namespace hamgen {

// Degrees of freedom that neither S nor C couples to others.
struct LinearPart {
  Scheme scheme;
  ExactMatrix s;
};
[[nodiscard]] std::vector<LinearPart> parts_of(const Scheme& scheme, const ExactMatrix& s);

// What the powers of M do at this h.  Of numbers that are not `exact`, what they do for all that
// are near: S is changed by some units of the relative size `digits`, and the answer must stay.
[[nodiscard]] Powers powers_at(const RationalStep& step, const Rational& h, const ExactMatrix& s,
                               int free_motions, bool exact, const char* digits);

}  // namespace hamgen
