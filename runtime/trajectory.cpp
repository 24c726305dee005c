#include "runtime/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hamgen::runtime {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

bool all_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

void include(EnergyStatistics& energy, const EnergyRange& range) {
  energy.min = std::min(energy.min, range.min);
  energy.max = std::max(energy.max, range.max);
  energy.last = range.last;
}

// Note [pace]
// The clock and the stop flag are looked at after `steps` steps, a number that follows the speed:
// one at first, then up to eight times more each time, so that a look comes twice an interval.  A
// slow step is not waited for, and a fast one does not pay for the looking.
class Pace {
 public:
  explicit Pace(double interval) : interval_(interval) {}

  [[nodiscard]] long long steps() const { return steps_; }

  void took(double seconds) {
    const double factor = 0.5 * interval_ / std::max(seconds, 1e-9);
    const double next = static_cast<double>(steps_) * std::clamp(factor, 0.125, 8.0);
    steps_ = static_cast<long long>(std::clamp(next, 1.0, 1e12));
  }

 private:
  double interval_;
  long long steps_ = 1;
};

// Looks at H of the present state; false if the state or H is not finite.  Hands out a record if
// one is due.
bool observe(const Integrator& integrator, const IntegrateOptions& options, bool due,
             RunSummary& summary) {
  const std::vector<double> state = integrator.rounded_state();
  const double energy = integrator.library().energy(integrator.parameters(), state);
  if (!all_finite(state) || !std::isfinite(energy)) return false;
  if (!summary.energy) {
    summary.energy =
        EnergyStatistics{.initial = energy, .min = energy, .max = energy, .last = energy};
  }
  include(*summary.energy, {.min = energy, .max = energy, .last = energy});
  if (!due) return true;
  ++summary.records;
  if (!options.on_record) return true;
  const std::vector<double> invariants =
      integrator.library().invariants(integrator.parameters(), state);
  const auto step = static_cast<double>(summary.steps_done);
  options.on_record({.step = summary.steps_done,
                     .time = std::fma(step, integrator.h().hi, step * integrator.h().lo),
                     .state = state,
                     .energy = energy,
                     .invariants = invariants});
  return true;
}

// Adds what one call of the plugin did.
void add(RunSummary& summary, const Report& report) {
  summary.status = report.status;
  summary.steps_done += report.steps_done;
  summary.iterations += report.iterations;
  summary.last_iterations = report.last_iterations;
  summary.last_increment = report.last_increment;
  if (report.energy && summary.energy) include(*summary.energy, *report.energy);
}

bool is_due(long long step, long long every) { return every > 0 && step % every == 0; }

}  // namespace

double EnergyStatistics::max_error() const { return std::max(max - initial, initial - min); }

double RunSummary::iterations_per_step() const {
  return steps_done > 0 ? static_cast<double>(iterations) / static_cast<double>(steps_done) : 0.0;
}

double RunSummary::nanoseconds_per_step() const {
  return steps_done > 0 ? 1e9 * advance_seconds / static_cast<double>(steps_done) : 0.0;
}

RunSummary integrate(Integrator& integrator, const IntegrateOptions& options) {
  if (options.steps < 0 || options.every < 0) {
    throw std::invalid_argument(
        "the number of steps and the distance of records must not be "
        "negative");
  }
  RunSummary summary;
  const Clock::time_point begin = Clock::now();
  Clock::time_point last_look = begin;
  double last_report = 0.0;
  Pace pace(options.progress_interval.count());
  long long until_look = pace.steps();

  if (!observe(integrator, options, is_due(0, options.every), summary)) {
    summary.status = Status::not_finite;
  }
  while (summary.status == Status::done && summary.steps_done < options.steps) {
    long long steps = std::min(until_look, options.steps - summary.steps_done);
    if (options.every > 0) {
      steps = std::min(steps, options.every - summary.steps_done % options.every);
    }
    const Clock::time_point before = Clock::now();
    const Report report = integrator.advance(steps, options.watch_energy);
    summary.advance_seconds += seconds_since(before);
    add(summary, report);
    until_look -= steps;

    if (summary.status == Status::done) {
      const bool due = is_due(summary.steps_done, options.every);
      const bool last = summary.steps_done == options.steps;
      if ((due || last) && !observe(integrator, options, due, summary)) {
        summary.status = Status::not_finite;
      }
    }
    if (until_look > 0) continue;
    pace.took(std::chrono::duration<double>(Clock::now() - last_look).count());
    last_look = Clock::now();
    until_look = pace.steps();
    const bool more = summary.steps_done < options.steps;
    if (more && options.stop != nullptr && options.stop->load(std::memory_order_relaxed) &&
        summary.status == Status::done) {
      summary.status = Status::stopped;
    }
    const double seconds = seconds_since(begin);
    if (options.on_progress && seconds - last_report >= options.progress_interval.count()) {
      last_report = seconds;
      options.on_progress(
          {.steps_done = summary.steps_done, .steps = options.steps, .seconds = seconds});
    }
  }
  // A failed or stopped run still has a last good state, whose H may not have been looked at.
  if (summary.status != Status::done && summary.energy)
    observe(integrator, options, false, summary);
  summary.total_seconds = seconds_since(begin);
  if (options.on_progress) {
    options.on_progress({.steps_done = summary.steps_done,
                         .steps = options.steps,
                         .seconds = summary.total_seconds});
  }
  return summary;
}

}  // namespace hamgen::runtime
