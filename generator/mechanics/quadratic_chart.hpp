// H as a function of few quadratic forms: a central force depends on q.q and p.p only.
#pragma once

#include <optional>

#include "generator/mechanics/chart.hpp"
#include "generator/mechanics/mechanics.hpp"

namespace hamgen {

struct QuadraticChart {
  Chart chart;
  Expression energy;  // H in the chart's symbols
};

// The forms that H depends on with all that their products with the gauge lead to; nothing if H
// depends on something else, or if these are more than 2n + 1.
[[nodiscard]] std::optional<QuadraticChart> quadratic_chart(const Mechanics& mechanics,
                                                            const std::vector<SparseMatrix>& gauge);

}  // namespace hamgen
