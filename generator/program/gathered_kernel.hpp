// Sums over neighbours, the other way round: every element of the gradient is added up where it
// stands, from all instances that reach it, instead of every instance adding to all elements that
// it reaches.  Instances do not wait for each other then.
#pragma once

#include <vector>

#include "generator/mechanics/kernel.hpp"

namespace hamgen {

// Kernels with the same gradient: of the loop, whose gradient is by one slot of each array, and of
// the elements at both ends.  Only the gradient is theirs, no value and no Hessian, and it comes in
// parts: a slot is there once more for each of its own.  The kernel itself if it is no chain in one
// index, or so costly that an instance is not worth computing again for each of its elements.  What
// all instances add to one element is a kernel of its own, where that computes no function twice.
[[nodiscard]] std::vector<Kernel> gathered(const Kernel& kernel);

}  // namespace hamgen
