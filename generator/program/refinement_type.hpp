// The type of numerics/refinement.hpp that a routine declares, and what stands beside it.
#pragma once

#include <string>

namespace hamgen {

// Of so many unknowns and components of the gradient; does it round with a length besides?  See
// Note [forces that cancel].
[[nodiscard]] inline std::string refinement_type(int unknowns, int components, bool rounds_beside) {
  const char* const besides = rounds_beside ? ", true" : "";
  return "Refinement<" + std::to_string(unknowns) + ", " + std::to_string(components) + besides +
         ">";
}

}  // namespace hamgen
