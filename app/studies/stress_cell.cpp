// One cell of a stress grid.
#include <algorithm>
#include <cmath>
#include <span>

#include "app/studies/initial_data.hpp"
#include "app/studies/processor_time.hpp"
#include "app/studies/stress.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

constexpr double kBounded = 1e3;     // sizes, see Sizes
constexpr double kFarAway = 1e6;     // likewise: farther than any bounded motion of interest
constexpr double kHugeState = 1e50;  // likewise: beyond, a step that is not solved is an overflow
// Likewise: beyond, all of where H may end is within the rounding of a double.
constexpr double kNoDomain = 1e16;
constexpr double kJump = 10.0;  // energy scales

double largest_component(std::span<const double> state) {
  double largest = 0.0;
  for (const double value : state) largest = std::max(largest, std::fabs(value));
  return largest;
}

// What the components of a state are compared with: the largest at the start, or 1; momenta also
// with that of a mass of 1 that has all the energy of the scale as kinetic energy.
struct Sizes {
  double q = 1.0;
  double p = 1.0;

  [[nodiscard]] double of(const std::vector<double>& state) const {
    const std::span<const double> z(state);
    return std::max(largest_component(z.first(z.size() / 2)) / q,
                    largest_component(z.last(z.size() / 2)) / p);
  }
};

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

// The energy error is small beside p H_p/2 or q H_q/2 where the state is now.  A step that is
// unstable on a quadratic H errs by their sum.
bool keeps_energy(const runtime::Library& library, const std::vector<double>& parameters,
                  const std::vector<double>& state, const StressCell& cell) {
  constexpr double small = 0.1;
  const std::vector<double> gradient = library.gradient(parameters, state);
  const std::size_t n = state.size() / 2;
  const std::span<const double> z(state);
  const std::span<const double> slope(gradient);
  const double scale =
      std::max(half_product(z.first(n), slope.first(n)), half_product(z.last(n), slope.last(n)));
  return std::isfinite(scale) && cell.energy_error <= small * std::max(scale, cell.energy_scale);
}

StressOutcome failure_of(runtime::Status status, double largest, bool defined_everywhere) {
  switch (status) {
    case runtime::Status::not_converged:
      return largest > kHugeState ? StressOutcome::overflow : StressOutcome::not_converged;
    case runtime::Status::not_finite:
      return defined_everywhere || largest > kNoDomain ? StressOutcome::overflow
                                                       : StressOutcome::left_domain;
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
    case StressOutcome::undefined:
      return "undefined";
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

std::vector<runtime::Wide> run_stress_cell(const std::shared_ptr<const runtime::Library>& library,
                                           const runtime::InitialValues& start,
                                           const StressLimits& limits, StressCell& cell) {
  const double begin = thread_seconds();
  const std::vector<double> initial = rounded(start.state);
  const std::vector<double> parameters = rounded(start.parameters);
  const double energy = library->energy(parameters, initial);
  cell.energy_scale = energy_scale_of(*library, parameters, initial);
  const double size = std::max(1.0, largest_component(initial));
  const Sizes sizes{.q = size, .p = std::max(size, std::sqrt(2.0 * cell.energy_scale))};
  runtime::Integrator integrator(library, start);
  std::vector<int> iterations;
  double largest = 0.0;  // in sizes
  while (cell.steps_done < limits.steps) {
    const runtime::Report report = integrator.advance(1, true);
    if (report.status != runtime::Status::done) {
      iterations.push_back(report.last_iterations);
      // An orbit that reaches infinity in finite time ends so, however small the step.
      const bool escaped = largest > kBounded &&
                           keeps_energy(*library, parameters, integrator.rounded_state(), cell);
      cell.outcome = escaped ? StressOutcome::escaped
                             : failure_of(report.status, largest, limits.defined_everywhere);
      break;
    }
    ++cell.steps_done;
    iterations.push_back(report.last_iterations);
    largest = std::max(largest, sizes.of(integrator.rounded_state()));
    cell.energy_error = std::max(cell.energy_error, std::fabs(report.energy->last - energy));
    if (largest > kFarAway &&
        keeps_energy(*library, parameters, integrator.rounded_state(), cell)) {
      cell.outcome = StressOutcome::escaped;
      break;
    }
    if (thread_seconds() - begin > limits.time.count() || is_stopped(limits.stop)) {
      cell.outcome = StressOutcome::out_of_time;
      break;
    }
  }
  if (cell.steps_done == limits.steps || cell.outcome == StressOutcome::out_of_time) {
    if (cell.energy_error > kJump * cell.energy_scale) cell.outcome = StressOutcome::jumped;
  }
  cell.bounded = largest <= kBounded && cell.outcome != StressOutcome::overflow;
  if (iterations.empty()) return integrator.state();
  const auto middle = iterations.begin() + static_cast<std::ptrdiff_t>(iterations.size() / 2);
  std::ranges::nth_element(iterations, middle);
  cell.iterations_median = *middle;
  cell.iterations_max = *std::ranges::max_element(iterations);
  return integrator.state();
}

}  // namespace hamgen::app
