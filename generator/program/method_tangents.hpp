// Tangent maps dZ/dz of methods whose step is not one system of equations, each the product of the
// maps of its parts: tangent(par, h, z, dz, m).
#pragma once

#include "generator/program/program.hpp"
#include "generator/program/tangent_products.hpp"

namespace hamgen {

[[nodiscard]] Routine splitting_tangent(const Environment& environment, const LoweredStep& lowered);
// With substep_tangent of its member.
[[nodiscard]] Routine composition_tangent(const Environment& environment,
                                          const LoweredStep& lowered, const Program& code);
[[nodiscard]] Routine explicit_runge_kutta_tangent(const Environment& environment,
                                                   const LoweredStep& lowered);
// Of sweeps instead of a solution, each linearised.
[[nodiscard]] Routine sweeps_tangent(const Environment& environment, const LoweredStep& lowered,
                                     std::string name);
// Of an implicit Runge-Kutta method: the matrix of Newton's iteration with the Hessian of every
// stage.
[[nodiscard]] Routine stages_tangent(const Environment& environment, const LoweredStep& lowered,
                                     const Program& code);
// Of a member in loops that solves equations, or none.
[[nodiscard]] Routine loop_member_tangent(const Environment& environment,
                                          const LoweredStep& lowered, const Program& code,
                                          std::string name);

}  // namespace hamgen
