// Which loop writes the elements of a gradient where the others add to them.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "generator/mechanics/kernel.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// The first and the last of elements that follow each other, several times.
using Elements = std::vector<std::pair<long, long>>;

struct FirstLoop {
  const Kernel* kernel = nullptr;
  Elements covered;  // in their order
};
// The loop that meets elements of dH/dq, or of dH/dp, before any other does: none if it meets one
// of them more than once.
[[nodiscard]] std::optional<FirstLoop> first_loop(const std::vector<Kernel>& kernels, bool momenta,
                                                  int degrees_of_freedom);
// Sets the elements of an array of n to zero that are not covered.
void add_zeros(Routine& routine, const std::string& array, const Elements& covered, int n);

}  // namespace hamgen
