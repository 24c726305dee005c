// The frequencies of an orbit, degree of freedom by degree of freedom.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "app/studies/frequencies.hpp"
#include "app/studies/stop.hpp"
#include "runtime/integrator.hpp"

namespace hamgen::app {

struct DegreeFrequencies {
  std::vector<Harmonic> harmonics;  // of q + i p
  // The largest one's frequency in the last half of so many steps less that in the first: rounding
  // on a regular orbit, diffusion on a chaotic one.  Empty where there are too few steps for it.
  std::optional<double> change = {};
};

// Of an orbit of `steps` steps: of the first 65536 of them, or all.  Empty where the orbit ends
// before or `stop` is set.
[[nodiscard]] std::vector<DegreeFrequencies> orbit_frequencies(
    const std::shared_ptr<const runtime::Library>& library, const runtime::InitialValues& start,
    long steps, int count, StopFlag stop);

}  // namespace hamgen::app
