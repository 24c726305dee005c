// The generating function of the exact flow as a power series in h.
//
// The flow of H is the step  Z = z + h J grad K(zbar),  zbar = (z + Z)/2 + C (Z - z),  whose
// generating function S(zbar, h) = h K(zbar, h) solves
//
//   dS/dh = H(zbar + (1/2 - C) J grad S) - (1/2) grad S^T (dC/dh) J grad S,    S = h H + O(h^2)
#pragma once

#include <vector>

#include "generator/mechanics/chart.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

// C_0, C_1, ... with C = sum of h^l C_l, as far as C_(count - 1).  Throws UsageError where C has no
// such series.
[[nodiscard]] std::vector<SparseMatrix> gauge_series(const SparseMatrix& c, int count);

// No even powers: C(-h) = -C(h), the member is symmetric.
[[nodiscard]] bool is_odd(const std::vector<SparseMatrix>& gauge);

// The coordinates as a chart, of all degrees of freedom or of these symbols, q first.
[[nodiscard]] Chart coordinate_chart(const Mechanics& mechanics,
                                     const std::vector<SparseMatrix>& gauge);
[[nodiscard]] Chart coordinate_chart(std::vector<Expression> symbols,
                                     const std::vector<SparseMatrix>& gauge);

// How much is multiplied out: nothing, so that subexpressions stay shared; or everything, so that
// terms cancel.  Which of the two is shorter depends on H.
enum class SeriesForm { nested, expanded };

// Terms of a polynomial, and operations of a gradient, beyond which no series is pursued.  A
// compiler takes about a millisecond for an operation.
inline constexpr std::size_t kMostTerms = 4000;
inline constexpr long kMostOperations = 12000;

// S_1 = H, S_2, ..., S_count with S = sum of h^k S_k, in the chart's symbols.  `energy` is H in
// these.  Throws TooManyTerms.
[[nodiscard]] std::vector<Expression> generating_series(const Expression& energy,
                                                        const Chart& chart,
                                                        const std::vector<SparseMatrix>& gauge,
                                                        int count, SeriesForm form);

}  // namespace hamgen
