// What an emitted file has of a step, in C++.
#pragma once

#include "generator/formats/emit_context.hpp"

namespace hamgen {

void write_pieces(CodeWriter& out, EmitContext& context, const std::vector<Piece>& pieces);

// Each in a file of its own.
void write_propagator(CodeWriter& out, EmitContext& context, const Propagator& propagator);
void write_watch(CodeWriter& out, const EmitContext& context, const Watch& watch);

}  // namespace hamgen
