// Programs whose numbers are packs: W trajectories together.
#pragma once

#include <string_view>

#include "generator/formats/emit_options.hpp"

namespace hamgen {

// Throws UsageError, and says why, for what is not there in lanes.
void require_lanes(const EmitOptions& options);
// Throws UsageError if the options ask for lanes, of which `what` knows nothing.
void refuse_lanes(const EmitOptions& options, std::string_view what);

}  // namespace hamgen
