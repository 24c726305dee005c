// What takes steps of W trajectories together: the class Propagator and the function step of a
// batch.
#pragma once

#include <string_view>

#include "generator/formats/emit_context.hpp"

namespace hamgen {

// Flags that differ from lane to lane become masks.  Throws UsageError, and says why, for a step
// that is not there in lanes.
[[nodiscard]] Program in_lanes(Program program, const EmitOptions& options);
// Throws UsageError if the options ask for lanes, of which `what` knows nothing.
void refuse_lanes(const EmitOptions& options, std::string_view what);

// The class Propagator and step(par, h, z).
void write_lane_steps(CodeWriter& out, const EmitContext& context);

}  // namespace hamgen
