// What the stages of a Runge-Kutta method are rounded with besides where forces cancel.
#pragma once

#include <optional>

#include "generator/program/lowered_step.hpp"
#include "generator/program/routine_builder.hpp"

namespace hamgen {

// What forces that cancel round coordinates with, and momenta where these are unknowns, else 0: see
// Note [forces that cancel].
//   k.beside, k.beside_p, k.reach
struct StageRounding {
  Expression q, p;
  Expression reach;  // of coordinates once each
};
// None where there are no such forces, or where H is not p^2/2m + V(q).
[[nodiscard]] std::optional<StageRounding> stages_rounded_beside(const LoweredStep& lowered);

// start.beside = start.state and these, near zero, where there are so many numbers of coordinates,
// each of them so many times; those of momenta behind.
void add_rounding(RoutineBuilder& b, const StageRounding& rounding, int coordinates, int times);

}  // namespace hamgen
