// Steps that are not a member's alone.
#pragma once

#include "generator/formats/cpp_context.hpp"

namespace hamgen {

// Each writes what stands between the types and the end of the namespace: functions, Propagator,
// step.  The composition comes after its member's class Substep.
void write_array_composition(CodeWriter& out, const CppContext& context);
void write_runge_kutta(CodeWriter& out, CppContext& context, const RungeKutta& tableau);

// One step by a propagator made for it: step(par, h, z).
void write_single_step(CodeWriter& out);

// Reads State as an array x[2n], and back: add_to(z, carry, dz) by compensated sums.
void write_flat_state(CodeWriter& out, const CppContext& context, bool with_rest);

}  // namespace hamgen
