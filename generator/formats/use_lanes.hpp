// Programs whose numbers are packs: W trajectories together.
#pragma once

#include <string_view>

#include "generator/formats/emit_options.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// Throws UsageError, and says why, for a step that is not there in lanes.
void require_lanes(const Program& program, const EmitOptions& options);
// Throws UsageError if the options ask for lanes, of which `what` knows nothing.
void refuse_lanes(const EmitOptions& options, std::string_view what);

}  // namespace hamgen
