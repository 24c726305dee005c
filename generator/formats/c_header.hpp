// The format `c-header`, a header in C11 of what needs few fixed blocks, those in
// generator/numerics/c, and those of languages that are C but for some words.
#pragma once

#include <string_view>

#include "generator/formats/emit_options.hpp"
#include "generator/formats/output_files.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// In the language of the family that has a format of this name.  Throws UsageError where the step
// takes more: matrices, fixed points, loops, a tangent map.
[[nodiscard]] OutputFiles c_header_files(std::string_view format, const Program& program,
                                         const EmitOptions& options);

}  // namespace hamgen
