// The stages of an implicit Runge-Kutta method: tableau, iteration, many steps.
#pragma once

#include "generator/formats/cpp_context.hpp"

namespace hamgen {

// Uses vector_field, read and add of the emitted file.
void write_stages(CodeWriter& out, CppContext& context, const RungeKutta& tableau);

// hessian(par, z, values) of a state as one array.
void write_stage_hessian(CodeWriter& out, CppContext& context);

}  // namespace hamgen
