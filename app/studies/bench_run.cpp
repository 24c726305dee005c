#include "app/studies/bench_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studies/bench_refine.hpp"
#include "app/studies/load_integrator.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/compiler.hpp"

namespace hamgen::app {
namespace {

constexpr long kMostSteps = 100'000'000;

// h is changed a little where it does not divide the time, so that every row ends at the same time.
long step_count(const Rational& time, const Rational& h) {
  const Rational count = time / h;
  const double wanted = to_double(count);
  if (!(wanted > 0.0) || wanted > static_cast<double>(kMostSteps))
    throw UsageError(
        fmt::format("h = {:g} makes {:.3g} steps of the time {:g}\nhelp: between 1 and "
                    "1e8 can be measured; change --h or --time",
                    to_double(h), wanted, to_double(time)));
  return std::max(1L, static_cast<long>(std::ceil(wanted - 1e-9)));
}

BenchRow row_of(std::size_t method, const Rational& time, const Rational& h) {
  BenchRow row{.method = method};
  row.steps = step_count(time, h);
  row.h = time / row.steps;
  return row;
}

std::vector<BenchMethod> methods_of(const BenchRequest& request) {
  std::vector<BenchMethod> methods;
  for (const BenchSpec& each : request.methods)
    methods.push_back(bench_method(each.spec, request.setting.source, each.request,
                                   request.compiler, request.stop));
  if (std::ranges::none_of(methods, [](const BenchMethod& m) { return m.refusal.empty(); }))
    throw UsageError(fmt::format("none of the schemes suits {}: {}", request.setting.source.path,
                                 methods.front().refusal));
  return methods;
}

ReferenceSolution reference_of(const BenchRequest& request) {
  Work work(request.on_progress, "reference");
  return reference_solution(request.setting.source, request.scene, request.time,
                            {.sizes = request.setting.request.sizes,
                             .compiler = request.compiler,
                             .stop = request.stop,
                             .on_progress = work.fraction()});
}

void measure_all_errors(const BenchRequest& request, Bench& bench) {
  long long all = 0;
  for (const BenchRow& row : bench.rows) all += row.steps;
  Work work(request.on_progress, "errors", all, true);
  long long done = 0;
  for (BenchRow& row : bench.rows) {
    if (is_stopped(request.stop)) return;
    measure_errors(bench.methods[row.method], request.scene, bench.reference, row, request.clock);
    work.tell(done += row.steps);
  }
}

// Round by round over all rows: what slows the machine for a while slows them alike.
void measure_all_times(const BenchRequest& request, Bench& bench) {
  long long all = 0;
  for (const BenchRow& row : bench.rows) all += row.ok() ? row.steps * row.runs_per_sample : 0;
  Work work(request.on_progress, "times", all * request.rounds, true);
  long long done = 0;
  for (long round = 0; round < request.rounds; ++round) {
    for (BenchRow& row : bench.rows) {
      if (is_stopped(request.stop)) return;
      if (!row.ok()) continue;
      measure_time(bench.methods[row.method], request.scene, row, request.clock);
      work.tell(done += row.steps * row.runs_per_sample);
    }
  }
}

// No step is finer than a 64th of the finest that was asked for.
void add_steps_for_targets(const BenchRequest& request, Bench& bench) {
  constexpr double furthest = 64;
  const double length = std::fabs(to_double(request.time));
  double least = HUGE_VAL;
  for (const Rational& h : request.steps) least = std::min(least, std::fabs(to_double(h)));
  Work work(request.on_progress, "target");
  const auto tell = work.fraction();
  const auto count = static_cast<double>(request.targets.size());
  for (std::size_t i = 0; i < request.targets.size() && !is_stopped(request.stop); ++i) {
    const auto on_progress = [&tell, count, i](double part) {
      tell((static_cast<double>(i) + part) / count);
    };
    add_refined_rows(bench, {.target = request.targets[i],
                             .time = request.time,
                             .finest = std::max(least / furthest, length / kMostSteps),
                             .measure =
                                 [&](BenchRow& row) {
                                   measure_errors(bench.methods[row.method], request.scene,
                                                  bench.reference, row, request.clock);
                                   return !is_stopped(request.stop);
                                 },
                             .on_progress = on_progress});
  }
}

}  // namespace

Bench run_bench(const BenchRequest& request) {
  Bench bench{.model = request.setting.model.name,
              .path = request.setting.source.path,
              .scene = request.scene.name,
              .time = to_double(request.time),
              .observed = request.observed};
  bench.provenance = runtime::provenance_of(chosen_compiler(request.compiler));
  bench.methods = methods_of(request);
  for (std::size_t m = 0; m < bench.methods.size(); ++m) {
    for (const Rational& h : request.steps) bench.rows.push_back(row_of(m, request.time, h));
  }
  bench.reference = reference_of(request);
  if (bench.reference.state.empty()) bench.observed = Observed::energy;
  measure_all_errors(request, bench);
  if (!request.targets.empty()) add_steps_for_targets(request, bench);
  measure_all_times(request, bench);
  for (const double target : request.targets)
    bench.answers.push_back(
        {.target = target, .row = quickest_within(bench.rows, bench.observed, target)});
  return bench;
}

}  // namespace hamgen::app
