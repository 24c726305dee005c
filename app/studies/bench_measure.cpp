#include "app/studies/bench_measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "runtime/processor_time.hpp"
#include "runtime/trajectory.hpp"

namespace hamgen::app {
namespace {

runtime::InitialValues start_of(const BenchMethod& method, const SceneValues& scene,
                                const BenchRow& row) {
  SceneValues values = scene;
  values.h = row.h;
  values.steps = row.steps;
  return initial_values(method.plugin, values, *method.loaded.library);
}

// Without a chance to stop for at most so many steps.
constexpr long long kStepsAtOnce = 1 << 20;

std::string outcome_of(const runtime::RunSummary& summary) {
  if (summary.status == runtime::Status::done) return "done";
  return fmt::format("{} in step {}", runtime::to_text(summary.status), summary.steps_done + 1);
}

// Euclidean, from the reference, of the components from `begin` on that are known of both.
double part_error(const std::vector<runtime::Wide>& state, const std::vector<runtime::Wide>& exact,
                  std::size_t begin) {
  double sum = 0.0;
  for (std::size_t i = begin; i < begin + state.size() / 2; ++i) {
    if (!std::isfinite(state[i].hi)) continue;
    const double error = runtime::difference(state[i], exact[i]);
    sum += error * error;
  }
  return std::sqrt(sum);
}

// The sorted samples' value at a fraction of their number, between neighbours linear.
double quantile(const std::vector<double>& sorted, double fraction) {
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

BenchMethod bench_method(const std::string& spec, const SourceText& source, const Request& request,
                         const CompilerChoice& compiler, StopFlag stop) {
  BenchMethod method{.spec = spec, .request = request, .stop = stop};
  try {
    method.plugin = generate_plugin(source, request);
  } catch (const ModelError& error) {
    method.refusal = first_line(error.what());
  } catch (const UsageError& error) {
    method.refusal = first_line(error.what());
  }
  if (method.refusal.empty()) method.loaded = load_integrator(method.plugin, compiler, stop);
  return method;
}

std::optional<double> BenchRow::relative_energy_error() const {
  if (!energy_error || !(energy_scale > 0.0)) return {};
  return *energy_error / energy_scale;
}

std::optional<double> BenchRow::lasting_energy_error() const {
  const std::optional<double> error = relative_energy_error();
  if (!error || !later_energy_error || !(*later_energy_error > 2.0 * *energy_error)) return error;
  return *later_energy_error / energy_scale;
}

BenchTime time_of(const BenchRow& row) {
  if (row.samples.empty()) return {};
  std::vector<double> sorted = row.samples;
  std::ranges::sort(sorted);
  const double median = quantile(sorted, 0.5);
  const double time = std::fabs(to_double(row.h)) * static_cast<double>(row.steps);
  return {.seconds_per_time = median / time,
          .nanoseconds_per_step = 1e9 * median / static_cast<double>(row.steps),
          .spread = (quantile(sorted, 0.75) - quantile(sorted, 0.25)) / median};
}

// The steps wait for nothing, so on an idle machine processor time is that of the wall clock.
double processor_clock(const BenchMethod& method, const runtime::InitialValues& start, long steps) {
  runtime::Integrator integrator(method.loaded.library, start);
  const double begin = runtime::thread_seconds();
  for (long long left = steps; left > 0 && !is_stopped(method.stop); left -= kStepsAtOnce)
    static_cast<void>(integrator.advance(std::min(left, kStepsAtOnce), false));
  return runtime::thread_seconds() - begin;
}

double gradients_per_step(const Method& method, double iterations_per_step) {
  struct Count {
    double iterations;
    double operator()(const Member&) const { return iterations > 0.0 ? iterations : 1.0; }
    double operator()(const Composition& composition) const {
      return iterations > 0.0 ? iterations : static_cast<double>(composition.substeps.size());
    }
    double operator()(const Splitting& splitting) const {
      const bool closed = splitting.kicks.size() > splitting.drifts.size();
      return static_cast<double>(splitting.kicks.size() - (closed ? 1 : 0));
    }
    double operator()(const RungeKutta& rule) const {
      return static_cast<double>(rule.b.size()) * (rule.is_explicit() ? 1.0 : iterations);
    }
  };
  return std::visit(Count{iterations_per_step}, method);
}

void measure_errors(const BenchMethod& method, const SceneValues& scene,
                    const ReferenceSolution& reference, BenchRow& row, const RunClock& clock) {
  if (!method.refusal.empty()) {
    row.outcome = "refused: " + method.refusal;
    return;
  }
  const runtime::InitialValues start = start_of(method, scene, row);
  runtime::Integrator integrator(method.loaded.library, start);
  const std::vector<runtime::Wide> before = integrator.invariants();
  row.invariant_errors.assign(before.size(), 0.0);
  runtime::IntegrateOptions options;
  options.steps = row.steps;
  options.every = before.empty() ? 0 : std::max(1L, row.steps / 200);
  options.stop = method.stop;
  options.on_record = [&](const runtime::Record& record) {
    for (std::size_t i = 0; i < before.size(); ++i)
      row.invariant_errors[i] = std::max(
          row.invariant_errors[i], std::fabs(runtime::difference(record.invariants[i], before[i])));
  };
  const runtime::RunSummary summary = runtime::integrate(integrator, options);
  row.outcome = outcome_of(summary);
  row.iterations_per_step = summary.iterations_per_step();
  const Scheme* scheme = method.request.scheme->scheme;
  row.gradients_per_step =
      gradients_per_step(scheme != nullptr ? scheme->method : Member(), row.iterations_per_step);
  if (!row.ok()) return;
  if (summary.energy) {
    row.energy_error = summary.energy->max_error();
    row.energy_spread = summary.energy->spread();
  }
  row.energy_scale = summary.energy_terms;
  if (!reference.state.empty()) {
    const std::vector<runtime::Wide> state = whole_state(method.plugin, scene, integrator.state());
    row.state_error =
        distance(known_state(method.plugin, state), known_state(method.plugin, reference.state));
    row.q_error = part_error(state, reference.state, 0);
    row.p_error = part_error(state, reference.state, state.size() / 2);
  }
  row.once = clock(method, start, row.steps);
  row.runs_per_sample = static_cast<long>(std::clamp(std::ceil(2e-3 / row.once), 1.0, 1e5));
}

void look_longer(const BenchMethod& method, const SceneValues& scene, BenchRow& row) {
  constexpr long kTimesAsLong = 10;
  constexpr long kLeastSteps = 5000;
  constexpr double kTimesTheError = 100.0;
  constexpr double kWorst = 1e-2;  // an orbit may become livelier, and smaller errors with it
  runtime::Integrator integrator(method.loaded.library, start_of(method, scene, row));
  runtime::IntegrateOptions options;
  options.steps = std::max(kTimesAsLong * row.steps, kLeastSteps);
  options.stop = method.stop;
  const runtime::RunSummary summary = runtime::integrate(integrator, options);
  if (is_stopped(method.stop)) return;
  if (summary.status != runtime::Status::done) row.unstable = outcome_of(summary);
  if (!summary.energy || !row.energy_error || !(row.energy_scale > 0.0)) return;
  const double error = summary.energy->max_error();
  row.later_energy_error = error;
  const double most = std::max(kTimesTheError * *row.energy_error, kWorst * row.energy_scale);
  if (!row.unstable.empty() || error <= most) return;
  row.unstable =
      fmt::format("energy error {:.2g} in {} steps", error / row.energy_scale, options.steps);
}

void measure_time(const BenchMethod& method, const SceneValues& scene, BenchRow& row,
                  const RunClock& clock) {
  const runtime::InitialValues start = start_of(method, scene, row);
  double total = 0.0;
  for (long run = 0; run < row.runs_per_sample; ++run) total += clock(method, start, row.steps);
  row.samples.push_back(total / static_cast<double>(row.runs_per_sample));
}

}  // namespace hamgen::app
