#include "app/studies/bench_choice.hpp"

#include <algorithm>

namespace hamgen::app {

std::string_view to_text(Observed observed) {
  return observed == Observed::energy ? "energy" : "state";
}

std::optional<double> error_of(const BenchRow& row, Observed observed) {
  if (!row.ok()) return {};
  return observed == Observed::energy ? row.relative_energy_error() : row.state_error;
}

std::vector<std::size_t> pareto_front(const std::vector<BenchRow>& rows, Observed observed) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (error_of(rows[i], observed) && !rows[i].samples.empty()) order.push_back(i);
  }
  std::ranges::stable_sort(order, {},
                           [&](std::size_t i) { return time_of(rows[i]).seconds_per_time; });
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    if (front.empty() || *error_of(rows[i], observed) < *error_of(rows[front.back()], observed))
      front.push_back(i);
  }
  return front;
}

std::optional<std::size_t> quickest_within(const std::vector<BenchRow>& rows, Observed observed,
                                           double target) {
  for (const std::size_t i : pareto_front(rows, observed)) {
    if (*error_of(rows[i], observed) <= target) return i;
  }
  return {};
}

}  // namespace hamgen::app
