#include "app/studies/bench_choice.hpp"

#include <algorithm>

namespace hamgen::app {

std::string_view to_text(Observed observed) {
  return observed == Observed::energy ? "energy" : "state";
}

std::optional<double> error_of(const BenchRow& row, Observed observed) {
  if (!row.ok()) return {};
  return observed == Observed::energy ? row.lasting_energy_error() : row.state_error;
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

std::optional<std::size_t> quickest_within(const std::vector<BenchMethod>& methods,
                                           const std::vector<BenchRow>& rows, Observed observed,
                                           double target) {
  std::optional<std::size_t> best;
  const auto cost = [&rows](std::size_t row) { return time_of(rows[row]).seconds_per_time; };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const BenchRow& row = rows[i];
    const std::optional<double> error = error_of(row, observed);
    if (!error || !(*error <= target) || row.samples.empty()) continue;
    if (!row.unstable.empty() || methods[row.method].is_baseline) continue;
    if (!best || cost(i) < cost(*best)) best = i;
  }
  return best;
}

}  // namespace hamgen::app
