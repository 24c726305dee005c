// The format `c-header`: a header in C11 of what needs few fixed blocks, those in
// generator/numerics/c.
#pragma once

#include "generator/formats/emit_options.hpp"
#include "generator/formats/output_files.hpp"
#include "generator/program/program.hpp"

namespace hamgen {

// Throws UsageError where the step takes more: matrices, fixed points, loops, a tangent map.
[[nodiscard]] OutputFiles c_header_files(const Program& program, const EmitOptions& options);

}  // namespace hamgen
