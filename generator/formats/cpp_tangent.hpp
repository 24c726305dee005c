// The linearisation of an emitted step.
#pragma once

#include "generator/formats/cpp_context.hpp"

namespace hamgen {

// Can the tangent map of this program's step be written?  For members, solved or swept, whose sums
// are written out and that take H itself.
[[nodiscard]] bool has_tangent(const Program& program);

// hessian(par, z, values), stage_matrix(par, h, values) and tangent(par, h, z, dz, m).
void write_tangent(CodeWriter& out, CppContext& context);

}  // namespace hamgen
