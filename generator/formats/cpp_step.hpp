// The records and routines of a step in C++, and around them what takes steps: the function step
// and the class Propagator.
#pragma once

#include "generator/formats/emit_context.hpp"

namespace hamgen {

void write_record(CodeWriter& out, const Record& record, const ScalarType& scalar,
                  const std::string& base = "");

// prepare, the records solve works with, and solve.
void write_solver(CodeWriter& out, EmitContext& context);
// step(par, h, z) and the class Propagator.
void write_steps(CodeWriter& out, EmitContext& context);

}  // namespace hamgen
