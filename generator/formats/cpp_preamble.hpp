// The comment at the head of an emitted file: where it comes from and what it does.
#pragma once

#include "generator/formats/cpp_context.hpp"

namespace hamgen {

void write_preamble(CodeWriter& out, const CppContext& context);

}  // namespace hamgen
