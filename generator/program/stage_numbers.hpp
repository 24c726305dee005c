// The numbers of an implicit Runge-Kutta method.
#pragma once

#include <optional>

#include "generator/program/coefficients.hpp"
#include "generator/program/lowered_step.hpp"

namespace hamgen {

//   k.coupling[i][j] = a_ij / b_j
//   k.ahead[i][j]    from the L_j of one step to the increments Y_i - z of the next, on the same
//                    polynomial
//   k.scaled[i]      h b_i
// and where the momenta can be eliminated
//   k.twice[i][j]    h sum_m a_im a_mj / b_j
//   k.node[i]        h c_i
//   k.mobility[j]    d^2 H/dp_j^2, if one of them is not 1
// By component tables are [j][i], and 0 for what is no stage.
[[nodiscard]] Coefficients stage_coefficients(const Environment& environment,
                                              const LoweredStep& lowered);

}  // namespace hamgen
