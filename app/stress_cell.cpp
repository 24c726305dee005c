// One cell of a stress grid.
#include <algorithm>
#include <cmath>
#include <span>

#include "app/initial_data.hpp"
#include "app/interrupt.hpp"
#include "app/stress.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

constexpr double kBounded = 1e3;     // times the largest component at the start, or 1
constexpr double kFarAway = 1e6;     // likewise: farther than any bounded motion of interest
constexpr double kJump = 10.0;       // energy scales
constexpr double kHugeState = 1e50;  // beyond, a value that is not finite is an overflow

double largest_component(std::span<const double> state) {
  double largest = 0.0;
  for (const double value : state) largest = std::max(largest, std::fabs(value));
  return largest;
}

double norm_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

double half_product(std::span<const double> x, std::span<const double> y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return std::fabs(0.5 * sum);
}

StressOutcome failure_of(runtime::Status status, double largest) {
  switch (status) {
    case runtime::Status::not_converged:
      return largest > kHugeState ? StressOutcome::overflow : StressOutcome::not_converged;
    case runtime::Status::not_finite:
      return largest > kHugeState ? StressOutcome::overflow : StressOutcome::left_domain;
    case runtime::Status::done:
    case runtime::Status::stopped:
      break;
  }
  internal_error("not a failure");
}

}  // namespace

std::string_view to_text(StressOutcome outcome) {
  switch (outcome) {
    case StressOutcome::done:
      return "done";
    case StressOutcome::jumped:
      return "jumped";
    case StressOutcome::escaped:
      return "escaped";
    case StressOutcome::not_converged:
      return "not converged";
    case StressOutcome::left_domain:
      return "left the domain";
    case StressOutcome::overflow:
      return "overflow";
    case StressOutcome::out_of_time:
      return "out of time";
  }
  internal_error("no such outcome");
}

double energy_scale_of(const runtime::Library& library, const std::vector<double>& parameters,
                       const std::vector<double>& state) {
  const std::vector<double> gradient = library.gradient(parameters, state);
  const std::size_t n = state.size() / 2;
  const std::span<const double> z(state);
  const std::span<const double> slope(gradient);
  return std::max({std::fabs(library.energy(parameters, state)), norm_of(z) * norm_of(slope),
                   half_product(z.first(n), slope.first(n)),
                   half_product(z.last(n), slope.last(n))});
}

void run_stress_cell(const std::shared_ptr<const runtime::Library>& library,
                     const runtime::InitialValues& start, const StressLimits& limits,
                     StressCell& cell) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<double> initial = rounded(start.state);
  const std::vector<double> parameters = rounded(start.parameters);
  const double size = std::max(1.0, largest_component(initial));
  const double energy = library->energy(parameters, initial);
  cell.energy_scale = energy_scale_of(*library, parameters, initial);
  runtime::Integrator integrator(library, start);
  std::vector<int> iterations;
  double largest = size;
  while (cell.steps_done < limits.steps) {
    const runtime::Report report = integrator.advance(1, true);
    if (report.status != runtime::Status::done) {
      iterations.push_back(report.last_iterations);
      cell.outcome = failure_of(report.status, largest);
      break;
    }
    ++cell.steps_done;
    iterations.push_back(report.last_iterations);
    largest = std::max(largest, largest_component(integrator.rounded_state()));
    cell.energy_error = std::max(cell.energy_error, std::fabs(report.energy->last - energy));
    const bool kept = cell.energy_error <= cell.energy_scale;
    if (largest > kFarAway * size && kept) {
      cell.outcome = StressOutcome::escaped;
      break;
    }
    if (std::chrono::steady_clock::now() - begin > limits.time || interrupt_flag()) {
      cell.outcome = StressOutcome::out_of_time;
      break;
    }
  }
  if (cell.steps_done == limits.steps || cell.outcome == StressOutcome::out_of_time) {
    if (cell.energy_error > kJump * cell.energy_scale) cell.outcome = StressOutcome::jumped;
  }
  cell.bounded = largest <= kBounded * size && cell.outcome != StressOutcome::overflow;
  if (iterations.empty()) return;
  const auto middle = iterations.begin() + static_cast<std::ptrdiff_t>(iterations.size() / 2);
  std::ranges::nth_element(iterations, middle);
  cell.iterations_median = *middle;
  cell.iterations_max = *std::ranges::max_element(iterations);
}

}  // namespace hamgen::app
