#include "app/studies/bench_refine.hpp"

#include <algorithm>
#include <cmath>

#include "app/studies/bench_target.hpp"

namespace hamgen::app {
namespace {

constexpr std::size_t kMostTrials = 10;  // a method

// What is known of one method.
StepSearch search_of(const Bench& bench, std::size_t method, const std::vector<BenchRow>& trials,
                     double target) {
  StepSearch search{.order = static_cast<double>(bench.methods[method].plugin.order),
                    .target = target};
  for (const std::vector<BenchRow>* rows : {&bench.rows, &trials}) {
    for (const BenchRow& row : *rows) {
      if (row.method != method) continue;
      const double h = std::fabs(to_double(row.h));
      const std::optional<double> error = error_of(row, bench.observed);
      const bool is_known = error && std::isfinite(*error) && row.unstable.empty();
      search.samples.push_back({.h = h,
                                .error = is_known ? *error : HUGE_VAL,
                                .cost = row.once / (h * static_cast<double>(row.steps))});
    }
  }
  return search;
}

// The row of a step of that size; empty if it has been measured.
std::optional<BenchRow> trial_of(double h, const StepSearch& search, std::size_t method,
                                 const Rational& time) {
  const double length = std::fabs(to_double(time));
  const auto steps_of = [length](double step) { return std::lround(length / step); };
  long steps = std::max(1L, static_cast<long>(std::ceil(length / h - 1e-9)));
  // With few steps the next larger step can be far away.
  if (const StepSample* const in = search.inside()) steps = std::min(steps, steps_of(in->h) - 1);
  const bool is_known = std::ranges::any_of(
      search.samples, [&](const StepSample& sample) { return steps_of(sample.h) == steps; });
  if (steps < 1 || is_known) return {};
  return BenchRow{.method = method, .h = time / steps, .steps = steps};
}

// The row to measure next; empty if there is nothing to gain.
std::optional<BenchRow> next_trial(const StepSearch& search, std::size_t method,
                                   const Rational& time) {
  const std::optional<double> h = next_step(search);
  return h ? trial_of(*h, search, method, time) : std::nullopt;
}

// Methods by what the target should cost, so that those that cannot win are soon given up.
std::vector<std::size_t> by_promise(const Bench& bench, double target) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t m = 0; m < bench.methods.size(); ++m) {
    if (!bench.methods[m].is_baseline)
      order.emplace_back(search_of(bench, m, {}, target).expected_cost(), m);
  }
  std::ranges::sort(order);
  std::vector<std::size_t> methods;
  for (const auto& [cost, method] : order) methods.push_back(method);
  return methods;
}

double least_cost(const Bench& bench, double target) {
  double least = HUGE_VAL;
  for (std::size_t m = 0; m < bench.methods.size(); ++m) {
    if (bench.methods[m].is_baseline) continue;
    const StepSearch search = search_of(bench, m, {}, target);
    if (search.inside() != nullptr) least = std::min(least, search.inside()->cost);
  }
  return least;
}

}  // namespace

void add_refined_rows(Bench& bench, const Refinement& refinement) {
  double best_cost = least_cost(bench, refinement.target);
  double methods_done = 0.0;
  for (const std::size_t method : by_promise(bench, refinement.target)) {
    std::vector<BenchRow> trials;
    int interpolations = 0;
    StepSearch search;
    for (;;) {
      search = search_of(bench, method, trials, refinement.target);
      search.finest = refinement.finest;
      search.best_cost = best_cost;
      search.interpolations = interpolations;
      if (trials.size() == kMostTrials) break;
      std::optional<BenchRow> row = next_trial(search, method, refinement.time);
      if (!row) break;
      if (search.is_bracket()) ++interpolations;
      if (!refinement.measure(*row)) return;
      trials.push_back(std::move(*row));
      refinement.on_progress((methods_done + static_cast<double>(trials.size()) / kMostTrials) /
                             static_cast<double>(bench.methods.size()));
    }
    ++methods_done;
    for (const double h : larger_steps(search)) {
      std::optional<BenchRow> row = trial_of(h, search, method, refinement.time);
      if (!row) continue;
      if (!refinement.measure(*row)) return;
      trials.push_back(std::move(*row));
      search.samples = search_of(bench, method, trials, refinement.target).samples;
      if (search.inside()->h == std::fabs(to_double(trials.back().h))) break;
    }
    if (trials.empty()) continue;
    const StepSample* const in = search.inside();
    if (in != nullptr) best_cost = std::min(best_cost, in->cost);
    const StepSample& chosen = in != nullptr ? *in : *search.smallest();
    const auto kept = std::ranges::find_if(
        trials, [&chosen](const BenchRow& row) { return std::fabs(to_double(row.h)) == chosen.h; });
    if (kept != trials.end()) bench.rows.push_back(std::move(*kept));
  }
}

}  // namespace hamgen::app
