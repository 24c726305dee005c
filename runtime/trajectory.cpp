#include "runtime/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "runtime/processor_time.hpp"

namespace hamgen::runtime {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

bool all_finite(std::span<const Wide> values) {
  return std::ranges::all_of(values, [](const Wide& value) { return std::isfinite(value.hi); });
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

// Looks at H of the present state; false if the state or H is not finite, as they may be rounded to
// double.  Hands out a record if one is due.
bool observe(const Integrator& integrator, const IntegrateOptions& options, bool due,
             RunSummary& summary) {
  const std::vector<Wide> state = integrator.state();
  if (!all_finite(state)) return false;
  Wide energy{.hi = std::numeric_limits<double>::quiet_NaN(), .lo = 0.0};
  if (options.watch_energy) {
    energy = integrator.energy();
    if (!std::isfinite(energy.hi)) return false;
    if (!summary.energy) {
      summary.energy =
          EnergyStatistics{.initial = energy, .min = energy, .max = energy, .last = energy};
    }
    include(*summary.energy, {.min = energy, .max = energy, .last = energy});
  }
  if (!due) return true;
  ++summary.records;
  if (!options.on_record) return true;
  const std::vector<Wide> invariants = integrator.invariants();
  const auto step = static_cast<double>(summary.steps_done);
  options.on_record({.step = summary.steps_done,
                     .time = std::fma(step, integrator.h().hi, step * integrator.h().lo),
                     .state = state,
                     .energy = energy,
                     .invariants = invariants});
  return true;
}

void append(Report& total, const Report& report) {
  total.status = report.status;
  total.steps_done += report.steps_done;
  total.iterations += report.iterations;
  total.last_iterations = report.last_iterations;
  total.last_increment = report.last_increment;
  if (!report.energy) return;
  if (!total.energy) total.energy = report.energy;
  total.energy = EnergyRange{.min = std::min(total.energy->min, report.energy->min),
                             .max = std::max(total.energy->max, report.energy->max),
                             .last = report.energy->last};
}

double error_of(const EnergyRange& energy, const Wide& initial) {
  return std::max(difference(energy.max, initial), difference(initial, energy.min));
}

// Note [jumps]
// A step across a singularity solves its equations, and so does one that is far too large: what is
// wrong shows in the energy.  More than ten energy scales of the start are a jump, unless they are
// less than a tenth of the terms of H at that state: an orbit may begin next to an equilibrium
// where all of them vanish, and go far.  Then the limit is ten times that error from there on.  An
// orbit that begins with no scale at all, as at rest in the origin, gets that of its first terms.
//
// A call of the plugin tells the range of the energy only.  Where that is beyond the limit, its
// steps are repeated one by one.
class Steps {
 public:
  Steps(Integrator& integrator, const IntegrateOptions& options)
      : integrator_(integrator),
        watches_(options.watch_energy),
        limit_(options.end_at_jump ? integrator.judge().jump_limit()
                                   : std::numeric_limits<double>::infinity()) {}

  void restore(const RunState& state) {
    integrator_.restore(state.integrator);
    limit_ = state.jump_limit;
    largest_ = state.largest_error;
  }
  [[nodiscard]] RunState saved(const RunSummary& summary) const {
    return {.summary = summary,
            .jump_limit = limit_,
            .largest_error = largest_,
            .integrator = integrator_.saved()};
  }

  // A step that jumps is not done; `jump` is the energy error after it.
  Report advance(long long steps, std::optional<double>& jump) {
    const Report report = integrator_.advance(steps, watches_);
    if (!report.energy) return report;
    if (const double error = error_of(*report.energy, judge().energy()); !(error > limit_)) {
      largest_ = std::max(largest_, error);
      return report;
    }
    integrator_.go_back_to(integrator_.steps_done() - report.steps_done);
    Report total;
    while (total.steps_done < report.steps_done) {
      const long long before = integrator_.steps_done();
      const Report one = integrator_.advance(1, true);
      const double error = error_of(*one.energy, judge().energy());
      if (error > limit_ && !explains(error)) {
        integrator_.go_back_to(before);
        jump = error;
        total.status = judge().failure(Status::jumped, integrator_.rounded_state(), largest_);
        total.last_iterations = one.last_iterations;
        total.last_increment = one.last_increment;
        return total;
      }
      largest_ = std::max(largest_, error);
      append(total, one);
    }
    // The step that failed behind them, if one did.
    total.status = report.status;
    total.last_iterations = report.last_iterations;
    total.last_increment = report.last_increment;
    return total;
  }

 private:
  [[nodiscard]] const Judge& judge() const { return integrator_.judge(); }

  // Do the terms of H at the present state explain such an error?  Raises the limit.
  bool explains(double error) {
    const auto raised = judge().raised_limit(limit_, integrator_.rounded_state(), error);
    limit_ = raised.value_or(limit_);
    return raised.has_value();
  }

  Integrator& integrator_;
  bool watches_;
  double limit_;          // of the energy error
  double largest_ = 0.0;  // of the steps done
};

// When on_look is called next.
class Looks {
 public:
  explicit Looks(const IntegrateOptions& options) : options_(options) {}

  // Steps that nobody wants to look between.
  [[nodiscard]] long long distance() const {
    return options_.on_look ? distance_ : std::numeric_limits<long long>::max();
  }
  // Looks if it is time to; true if the run ends here.
  [[nodiscard]] bool end_at(const Integrator& integrator) {
    if (!options_.on_look) return false;
    distance_ -= integrator.steps_done() - looked_at_;
    looked_at_ = integrator.steps_done();
    if (distance_ > 0) return false;
    distance_ = options_.on_look(integrator);
    return distance_ <= 0;
  }

 private:
  const IntegrateOptions& options_;
  long long distance_ = 0;
  long long looked_at_ = 0;
};

// Adds what one call of the plugin did.
void add(RunSummary& summary, const Report& report) {
  summary.status = report.status;
  summary.steps_done += report.steps_done;
  summary.iterations += report.iterations;
  summary.last_iterations = report.last_iterations;
  summary.last_increment = report.last_increment;
  if (report.energy && summary.energy) include(*summary.energy, *report.energy);
}

// Of a state whose rounding to double has no H.
Status not_finite(const Integrator& integrator) {
  return integrator.judge().failure(Status::left_domain, integrator.rounded_state(), 0.0);
}

bool is_due(long long step, long long every) { return every > 0 && step % every == 0; }

}  // namespace

double EnergyStatistics::max_error() const {
  return std::max(difference(max, initial), difference(initial, min));
}

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
  summary.energy_scale = integrator.judge().energy_scale();
  Steps plugin(integrator, options);
  const Clock::time_point begin = Clock::now();
  Clock::time_point last_look = begin;
  double last_report = 0.0;
  Pace pace(std::min(options.progress_interval.count(), options.seconds.value_or(1e9) / 4.0));
  long long until_look = pace.steps();
  Clock::time_point last_save = begin;
  const double seconds_before = options.from != nullptr ? options.from->summary.total_seconds : 0.0;

  if (options.from != nullptr) {
    summary = options.from->summary;
    summary.status = Status::done;
    plugin.restore(*options.from);
  } else if (!observe(integrator, options, is_due(0, options.every), summary)) {
    summary.status = not_finite(integrator);
  }
  summary.energy_terms = integrator.judge().energy_terms();
  Looks looks(options);
  if (summary.status == Status::done) summary.ended = looks.end_at(integrator);
  while (summary.status == Status::done && !summary.ended && summary.steps_done < options.steps) {
    long long steps = std::min({until_look, options.steps - summary.steps_done, looks.distance()});
    if (options.every > 0) {
      steps = std::min(steps, options.every - summary.steps_done % options.every);
    }
    const double before = thread_seconds();
    const Report report = plugin.advance(steps, summary.jump);
    summary.advance_seconds += thread_seconds() - before;
    add(summary, report);
    until_look -= steps;

    if (summary.status == Status::done) {
      summary.ended = looks.end_at(integrator);
      const bool due = !summary.ended && is_due(summary.steps_done, options.every);
      const bool last = summary.ended || summary.steps_done == options.steps;
      if ((due || last) && !observe(integrator, options, due, summary)) {
        summary.status = not_finite(integrator);
      }
    }
    if (until_look > 0) continue;
    pace.took(std::chrono::duration<double>(Clock::now() - last_look).count());
    last_look = Clock::now();
    until_look = pace.steps();
    const bool more = !summary.ended && summary.steps_done < options.steps;
    if (more && summary.status == Status::done && options.seconds &&
        seconds_since(begin) >= *options.seconds) {
      summary.status = Status::out_of_time;
    }
    if (more && options.stop != nullptr && options.stop->load(std::memory_order_relaxed) &&
        summary.status == Status::done) {
      summary.status = Status::stopped;
    }
    if (options.on_save && more && summary.status == Status::done &&
        Clock::now() - last_save >= options.save_interval) {
      summary.total_seconds = seconds_before + seconds_since(begin);
      options.on_save(plugin.saved(summary));
      last_save = last_look = Clock::now();
    }
    const double seconds = seconds_before + seconds_since(begin);
    if (options.on_progress && seconds - last_report >= options.progress_interval.count()) {
      last_report = seconds;
      options.on_progress(
          {.steps_done = summary.steps_done, .steps = options.steps, .seconds = seconds});
    }
  }
  const bool may_go_on = summary.status == Status::done || summary.status == Status::stopped ||
                         summary.status == Status::out_of_time;
  if (options.on_save && may_go_on) {
    summary.total_seconds = seconds_before + seconds_since(begin);
    options.on_save(plugin.saved(summary));
  }
  // A failed or stopped run still has a last good state, whose H may not have been looked at.
  if (summary.status != Status::done && summary.energy)
    observe(integrator, options, false, summary);
  summary.total_seconds = seconds_before + seconds_since(begin);
  if (options.on_progress) {
    options.on_progress({.steps_done = summary.steps_done,
                         .steps = options.steps,
                         .seconds = summary.total_seconds});
  }
  return summary;
}

}  // namespace hamgen::runtime
