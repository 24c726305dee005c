// The functions of the state alone in an emitted file.
#pragma once

#include "generator/formats/emit_context.hpp"

namespace hamgen {

// energy(par, z), gradient(par, z, values), and the model's invariants(par, z, values).
void write_functions(CodeWriter& out, EmitContext& context);
// modified_energies(par, h, z, values) and modified_energy(par, h, z), if the program has them.
void write_modified_energies(CodeWriter& out, EmitContext& context);

}  // namespace hamgen
