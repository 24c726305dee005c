// The type of numerics/refinement.hpp that a routine declares, and what stands beside it.
#pragma once

#include <string>

namespace hamgen {

// Of so many unknowns and components of the gradient; does it round with a length besides (see Note
// [forces that cancel]), and have its rounds another form of the equations than its beginning?
[[nodiscard]] inline std::string refinement_type(int unknowns, int components, bool rounds_beside,
                                                 bool two_forms = false) {
  const char* const second = rounds_beside ? ", true, true" : ", false, true";
  const char* const first = rounds_beside ? ", true" : "";
  return "Refinement<" + std::to_string(unknowns) + ", " + std::to_string(components) +
         (two_forms ? second : first) + ">";
}
// In lanes, too.
[[nodiscard]] inline bool has_two_forms(const std::string& refinement_type) {
  return refinement_type.find(", true, true>") != std::string::npos ||
         refinement_type.find(", false, true>") != std::string::npos;
}

}  // namespace hamgen
