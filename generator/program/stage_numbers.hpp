// The numbers of an implicit Runge-Kutta method.
#pragma once

#include "generator/program/coefficients.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

//   k.coupling[i][j] = a_ij / b_j
//   k.ahead[i][j]    from the L_j of one step to the increments Y_i - z of the next, on the same
//                    polynomial
//   k.scaled[i]      h b_i
// In lanes it is [j][i], and 0 for what is no stage.
[[nodiscard]] Coefficients stage_coefficients(const LoweredStep& lowered);

}  // namespace hamgen
