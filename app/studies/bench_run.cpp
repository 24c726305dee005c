#include "app/studies/bench_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "app/studies/bench_range.hpp"
#include "app/studies/bench_refine.hpp"
#include "app/studies/load_integrator.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/compiler.hpp"

namespace hamgen::app {
namespace {

std::vector<BenchMethod> methods_of(const BenchRequest& request) {
  Work work(request.on_progress, "methods", static_cast<long long>(request.methods.size()));
  std::vector<BenchMethod> methods;
  long long done = 0;
  std::string refusal;
  for (const BenchSpec& each : request.methods) {
    if (is_stopped(request.stop)) break;
    BenchMethod method = bench_method(each.spec, request.setting.source, each.request,
                                      request.compiler, request.stop);
    method.is_baseline = each.is_baseline;
    if (refusal.empty()) refusal = method.refusal;
    if (method.refusal.empty() || !each.is_offered) methods.push_back(std::move(method));
    work.tell(++done);
  }
  if (std::ranges::none_of(methods, [](const BenchMethod& m) { return m.refusal.empty(); }) &&
      !is_stopped(request.stop))
    throw UsageError(
        fmt::format("none of the schemes suits {}: {}", request.setting.source.path, refusal));
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

// One measurement, and what it leaves in the bench.
class BenchWork {
 public:
  BenchWork(const BenchRequest& request, Bench& bench) : request_(&request), bench_(&bench) {}

  // A row for each method and step that was asked for.
  void measure_given_steps() {
    std::vector<BenchRow> rows;
    long long all = 0;
    for (std::size_t m = 0; m < bench_->methods.size(); ++m) {
      for (const Rational& h : request_->steps) {
        rows.push_back(row_of(m, request_->time, h));
        all += rows.back().steps;
      }
    }
    Work work(request_->on_progress, "errors", all, true);
    long long done = 0;
    for (BenchRow& row : rows) {
      if (!measure(row)) return;
      work.tell(done += row.steps);
      bench_->rows.push_back(std::move(row));
    }
  }

  void measure_ranges() {
    Work work(request_->on_progress, "errors", static_cast<long long>(bench_->methods.size()));
    for (std::size_t m = 0; m < bench_->methods.size() && !is_stopped(); ++m) {
      add_rows_in_range(*bench_, m,
                        {.h = *request_->scene.h, .time = request_->time, .measure = measuring()});
      work.tell(static_cast<long long>(m) + 1);
    }
  }

  // Further rows, where they reach the targets sooner.
  void refine() {
    Work work(request_->on_progress, "targets");
    const auto tell = work.fraction();
    const auto count = static_cast<double>(request_->targets.size());
    for (std::size_t i = 0; i < request_->targets.size() && !is_stopped(); ++i) {
      refine(request_->targets[i],
             [&tell, count, i](double part) { tell((static_cast<double>(i) + part) / count); });
    }
  }

  // Of the rows that have none yet.  Round by round over all of them: what slows the machine for a
  // while slows them alike.
  void measure_times() {
    std::vector<BenchRow*> rows;
    long long all = 0;
    for (BenchRow& row : bench_->rows) {
      if (!row.ok() || !row.samples.empty()) continue;
      rows.push_back(&row);
      all += row.steps * row.runs_per_sample;
    }
    if (rows.empty()) return;
    Work work(request_->on_progress, "times", all * request_->rounds, true);
    long long done = 0;
    for (long round = 0; round < request_->rounds; ++round) {
      for (BenchRow* row : rows) {
        measure_time(bench_->methods[row->method], request_->scene, *row, request_->clock);
        if (is_stopped()) {
          row->samples.pop_back();  // cut short
          return;
        }
        work.tell(done += row->steps * row->runs_per_sample);
      }
    }
  }

  // The quickest row for a target, of those that last.
  BenchAnswer answer(double target) {
    constexpr int most_refinements = 8;
    for (int refinements = 0;;) {
      const auto row = quickest_within(bench_->methods, bench_->rows, bench_->observed, target);
      if (!row || lasts(*row, target) || is_stopped()) return {.target = target, .row = row};
      if (!request_->refines || refinements++ == most_refinements) continue;
      refine(target, [](double) {});
      measure_times();
    }
  }

 private:
  [[nodiscard]] bool is_stopped() const { return app::is_stopped(request_->stop); }

  bool measure(BenchRow& row) {
    measure_errors(bench_->methods[row.method], request_->scene, bench_->reference, row,
                   request_->clock);
    return !is_stopped();
  }
  [[nodiscard]] std::function<bool(BenchRow&)> measuring() {
    return [this](BenchRow& row) { return measure(row); };
  }

  // No step is finer than a 64th of the finest that was asked for, a 1024th of the scene's.
  [[nodiscard]] double finest_step() const {
    double least = std::fabs(to_double(*request_->scene.h)) / 16;
    if (!request_->steps.empty()) least = HUGE_VAL;
    for (const Rational& h : request_->steps) least = std::min(least, std::fabs(to_double(h)));
    return std::max(least / 64, std::fabs(to_double(request_->time)) / kMostBenchSteps);
  }

  void refine(double target, const std::function<void(double)>& on_progress) {
    add_refined_rows(*bench_, {.target = target,
                               .time = request_->time,
                               .finest = finest_step(),
                               .measure = measuring(),
                               .on_progress = on_progress});
  }

  bool lasts(std::size_t index, double target) {
    BenchRow& row = bench_->rows[index];
    if (!tried_.insert({row.method, row.steps}).second) return true;
    const Work work(request_->on_progress, "longer run");
    look_longer(bench_->methods[row.method], request_->scene, row);
    return row.unstable.empty() && error_of(row, bench_->observed) <= target;
  }

  const BenchRequest* request_;
  Bench* bench_;
  std::set<std::pair<std::size_t, long>> tried_;  // method and steps of what ran for longer
};

}  // namespace

Bench run_bench(const BenchRequest& request) {
  Bench bench{.model = request.setting.model.name,
              .path = request.setting.source.path,
              .scene = request.scene.name,
              .time = to_double(request.time),
              .observed = request.observed};
  bench.provenance = runtime::provenance_of(chosen_compiler(request.compiler), request.stop);
  // Before anything takes long: no run is too long.
  for (const Rational& h : request.steps.empty() ? std::vector{*request.scene.h} : request.steps)
    static_cast<void>(row_of(0, request.time, h));
  bench.methods = methods_of(request);
  if (request.observed == Observed::state && !is_stopped(request.stop)) {
    bench.reference = reference_of(request);
    if (bench.reference.state.empty()) bench.observed = Observed::energy;
  }
  BenchWork measurement(request, bench);
  if (request.steps.empty())
    measurement.measure_ranges();
  else
    measurement.measure_given_steps();
  if (request.refines) measurement.refine();
  measurement.measure_times();
  for (const double target : request.targets) bench.answers.push_back(measurement.answer(target));
  bench.is_stopped = is_stopped(request.stop);
  return bench;
}

}  // namespace hamgen::app
