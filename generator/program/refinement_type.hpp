// The type of numerics/refinement.hpp that a routine declares, and what stands beside it.
#pragma once

#include <string>

namespace hamgen {

// Of the field `near` of what rounds with a length besides: see Note [forces that cancel].
inline constexpr const char* kNearRemark = "1 where forces cancel, 0 far from there";

// Of so many unknowns and components of the gradient; does it round with a length besides?
[[nodiscard]] inline std::string refinement_type(int unknowns, int components, bool rounds_beside) {
  const char* const besides = rounds_beside ? ", true" : "";
  return "Refinement<" + std::to_string(unknowns) + ", " + std::to_string(components) + besides +
         ">";
}

}  // namespace hamgen
