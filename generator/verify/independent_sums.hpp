// The sums over all elements that a routine reads, as functions of the state.
#pragma once

#include <string>

#include "generator/verify/proof.hpp"

namespace hamgen {

// Do the sums take all values of an open set, whatever an element and its neighbours are?  Their
// Jacobian by the elements of each third of the system has full rank, which is seen at a point
// with 60 digits.  An element and its neighbours touch two thirds at most (growth.hpp).
[[nodiscard]] bool are_sums_independent(const SizedSystem& system, const std::string& routine);

}  // namespace hamgen
