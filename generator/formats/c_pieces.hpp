// What a C header has of a step.
#pragma once

#include "generator/formats/c_dialect.hpp"
#include "generator/formats/emit_context.hpp"

namespace hamgen {

void write_pieces(CodeWriter& out, EmitContext& context, const CDialect& dialect,
                  const std::vector<Piece>& pieces);

}  // namespace hamgen
