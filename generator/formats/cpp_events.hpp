// The events of the model along the steps: enum Event, Crossing and the class WatchedPropagator.
#pragma once

#include "generator/formats/emit_context.hpp"

namespace hamgen {

// Behind the class Propagator; nothing if the program has no events.
void write_events(CodeWriter& out, EmitContext& context);

}  // namespace hamgen
