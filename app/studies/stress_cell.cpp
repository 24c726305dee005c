// One cell of a stress grid.
#include <algorithm>
#include <cmath>

#include "app/studies/stress.hpp"
#include "runtime/processor_time.hpp"

namespace hamgen::app {
namespace {

using runtime::Status;

// Sizes, see runtime::Judge::size_of.
constexpr double kBounded = 1e3;
constexpr double kFarAway = 1e6;  // farther than any bounded motion of interest

}  // namespace

std::vector<runtime::Wide> run_stress_cell(const std::shared_ptr<const runtime::Library>& library,
                                           const runtime::InitialValues& start,
                                           const StressLimits& limits, StressCell& cell) {
  const double begin = runtime::thread_seconds();
  runtime::Integrator integrator(library, start);
  const runtime::Judge& judge = integrator.judge();
  cell.energy_scale = judge.energy_scale();
  std::vector<int> iterations;
  double largest = 0.0;  // in sizes
  while (cell.steps_done < limits.steps) {
    const runtime::Report report = integrator.advance(1, true);
    iterations.push_back(report.last_iterations);
    if (report.status != Status::done) {
      cell.outcome = report.status;
      break;
    }
    ++cell.steps_done;
    const std::vector<double> state = integrator.rounded_state();
    largest = std::max(largest, judge.size_of(state));
    cell.energy_error = std::max(
        cell.energy_error, std::fabs(runtime::difference(report.energy->last, judge.energy())));
    if (largest > kFarAway && judge.keeps_energy(state, cell.energy_error)) {
      cell.outcome = Status::escaped;
      break;
    }
    if (is_stopped(limits.stop)) {
      cell.outcome = Status::stopped;
      break;
    }
    if (runtime::thread_seconds() - begin > limits.time.count()) {
      cell.outcome = Status::out_of_time;
      break;
    }
  }
  if (cell.steps_done == limits.steps || cell.outcome == Status::out_of_time) {
    if (judge.is_jump(cell.energy_error)) cell.outcome = Status::jumped;
  }
  cell.bounded = largest <= kBounded && cell.outcome != Status::overflow;
  if (iterations.empty()) return integrator.state();
  const auto middle = iterations.begin() + static_cast<std::ptrdiff_t>(iterations.size() / 2);
  std::ranges::nth_element(iterations, middle);
  cell.iterations_median = *middle;
  cell.iterations_max = *std::ranges::max_element(iterations);
  return integrator.state();
}

}  // namespace hamgen::app
