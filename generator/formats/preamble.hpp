// The comment at the head of an emitted file: where it comes from and what it does.
#pragma once

#include "generator/formats/emit_context.hpp"

namespace hamgen {

void write_preamble(CodeWriter& out, const EmitContext& context);

}  // namespace hamgen
