#include "app/bench_choice.hpp"

#include <algorithm>
#include <cmath>

namespace hamgen::app {

std::string_view to_text(Observed observed) {
  return observed == Observed::energy ? "energy" : "state";
}

std::optional<double> error_of(const BenchRow& row, Observed observed) {
  if (!row.ok()) return {};
  return observed == Observed::energy ? row.energy_error : row.state_error;
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

std::optional<double> step_for_target(const std::vector<BenchRow>& rows, std::size_t method,
                                      Observed observed, double target) {
  struct Sample {
    double h = 0.0;
    double error = 0.0;
  };
  std::vector<Sample> samples;  // by falling h
  for (const BenchRow& row : rows) {
    const std::optional<double> error = error_of(row, observed);
    if (row.method == method && error && *error > 0.0)
      samples.push_back({std::fabs(to_double(row.h)), *error});
  }
  std::ranges::sort(samples, std::ranges::greater{}, &Sample::h);
  if (samples.size() < 2) return {};
  const auto good = std::ranges::find_if(
      samples, [target](const Sample& sample) { return sample.error <= target; });
  const bool found = good != samples.end();
  const bool first = good == samples.begin();
  const Sample& fine = first ? samples[1] : found ? *good : samples.back();
  const Sample& coarse = first ? samples[0] : found ? *(good - 1) : samples[samples.size() - 2];
  const double power = std::log(coarse.error / fine.error) / std::log(coarse.h / fine.h);
  if (power < 0.5) return {};  // round-off, or no convergence yet
  const double h = coarse.h * std::pow(target / coarse.error, 1.0 / power);
  constexpr double safety = 0.97;
  constexpr double furthest = 64.0;  // below the measured steps
  constexpr double largest = 8.0;    // times the largest of them
  if (h * furthest < fine.h) return {};
  return safety * std::min(h, largest * samples.front().h);
}

}  // namespace hamgen::app
