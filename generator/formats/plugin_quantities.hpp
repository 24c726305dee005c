// The parts of a plugin's interface that say what its numbers are, and that change a run.
#pragma once

#include "generator/formats/emit_context.hpp"

namespace hamgen {

// variable_list, parameter_list and invariant_list of the table.
void write_quantity_lists(CodeWriter& out, const EmitContext& context);

// Time, step and parameters, asked for and set.
void write_setters(CodeWriter& out, const EmitContext& context);

}  // namespace hamgen
