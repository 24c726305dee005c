// The C interface of runtime/plugin.h around an emitted integrator.
#pragma once

#include "generator/formats/emit_context.hpp"

namespace hamgen {

// Uses Parameters, State, Propagator, energy, gradient and invariants of the context's namespace.
void write_interface(CodeWriter& out, const EmitContext& context);

}  // namespace hamgen
