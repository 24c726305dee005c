// The linearisation of an emitted step: tangent(par, h, z, dz, m) for the step that moves z by dz.
#pragma once

#include <optional>
#include <string>

#include "generator/formats/cpp_arrays.hpp"
#include "generator/formats/cpp_context.hpp"

namespace hamgen {

// Why the tangent map of this program's step is not written, if it is not.
[[nodiscard]] std::optional<std::string> without_tangent(const Program& program);

[[nodiscard]] std::string tangent_name(StepRole role);
void write_member_tangent(CodeWriter& out, CppContext& context, StepRole role);
void write_splitting_tangent(CodeWriter& out, CppContext& context);
// The product of those of the substeps.
void write_composition_tangent(CodeWriter& out, const CppContext& context);
void write_explicit_tangent(CodeWriter& out, const CppContext& context);
// Of the stages as the class Propagator has found them: its member function, and the free one.
[[nodiscard]] std::string stages_tangent();
void write_stages_tangent(CodeWriter& out);

}  // namespace hamgen
