// Where the orbits of a section begin.
#pragma once

#include <vector>

#include "app/studies/section.hpp"

namespace hamgen::app {

struct SectionStarts {
  std::vector<std::vector<runtime::Wide>> states;
  int tried = 0;
  int unreachable = 0;
};

// By how much H falls from the energy of the request to its least over the momentum that gives it,
// at the scene's start: of what moves there, without constants of H.
[[nodiscard]] double energy_of_momentum(const SectionRequest& request);

// So many, spread over the region that the energy leaves, the same ones each time.
[[nodiscard]] SectionStarts section_starts(const SectionRequest& request);

}  // namespace hamgen::app
