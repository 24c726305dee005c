// What takes steps, in C: X_step and X_Propagator with its functions.
#pragma once

#include "generator/formats/c_dialect.hpp"
#include "generator/formats/emit_context.hpp"

namespace hamgen {

void write_c_record(CodeWriter& out, const Record& record, const CDialect& dialect);
void write_c_propagator(CodeWriter& out, EmitContext& context, const CDialect& dialect);

}  // namespace hamgen
