// Which method with which step is worth its time.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "app/studies/bench_measure.hpp"

namespace hamgen::app {

enum class Observed { energy, state };

[[nodiscard]] std::string_view to_text(Observed observed);  // "energy", "state"

// Of the energy relative to its scale, of the state |z - z*|.
[[nodiscard]] std::optional<double> error_of(const BenchRow& row, Observed observed);

// Indices of the rows that no other row beats in both time and error, by growing time.
[[nodiscard]] std::vector<std::size_t> pareto_front(const std::vector<BenchRow>& rows,
                                                    Observed observed);

// The quickest row whose error is at most `target`, of those that are stable and no baseline.
[[nodiscard]] std::optional<std::size_t> quickest_within(const std::vector<BenchMethod>& methods,
                                                         const std::vector<BenchRow>& rows,
                                                         Observed observed, double target);

}  // namespace hamgen::app
