#include "app/output/bench_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/output/plain_number.hpp"

namespace hamgen::app {
namespace {

constexpr std::size_t kMostCurves = 8;

double bench_floor(const Bench& bench, Observed observed) {
  constexpr double half_unit = std::numeric_limits<double>::epsilon() / 2;
  if (observed == Observed::energy) return half_unit;
  double square = 0.0;
  for (const runtime::Wide& value : bench.reference.state) square += value.hi * value.hi;
  return std::max(bench.reference.error, half_unit * std::sqrt(square));
}

// Not by time: where a solver fails to converge quickly, a larger step takes longer.
std::vector<const BenchRow*> rows_by_step(const Bench& bench, std::size_t method) {
  std::vector<const BenchRow*> rows;
  for (const BenchRow& row : bench.rows) {
    if (row.method == method) rows.push_back(&row);
  }
  std::ranges::sort(rows, {}, [](const BenchRow* row) { return row->steps; });
  return rows;
}

// Of points from the largest step on: without the first ones to which any smaller step is both
// faster and better, as where a solver takes more iterations than a larger step saves.
void drop_dominated(std::vector<PlotPoint>& points) {
  auto first = points.begin();
  for (; first != points.end(); ++first) {
    const bool loses = std::any_of(first + 1, points.end(), [first](const PlotPoint& small) {
      return small.x <= first->x && small.y <= first->y;
    });
    if (!loses) break;
  }
  points.erase(points.begin(), first);
}

}  // namespace

std::vector<bool> methods_to_draw(const Bench& bench) {
  const std::size_t count = bench.methods.size();
  if (count <= kMostCurves) return std::vector<bool>(count, true);
  std::vector<std::pair<int, std::size_t>> merit;  // negative: the largest first
  for (std::size_t m = 0; m < count; ++m)
    merit.emplace_back(bench.methods[m].is_baseline || m == 0 ? -1000 : 0, m);
  for (const Observed observed : {Observed::energy, Observed::state}) {
    for (const std::size_t row : pareto_front(bench.rows, observed))
      --merit[bench.rows[row].method].first;
  }
  std::ranges::sort(merit);
  std::vector<bool> drawn(count, false);
  for (std::size_t i = 0; i < kMostCurves; ++i) drawn[merit[i].second] = merit[i].first < 0;
  return drawn;
}

PlotPanel bench_panel(const Bench& bench, Observed observed) {
  PlotPanel panel{.title = "",
                  .x_label = "processor time for a unit of time [s]",
                  .y_label = observed == Observed::energy
                                 ? "energy error, relative"
                                 : fmt::format("|z − z*| at t = {}", plain_number(bench.time, 6)),
                  .logarithmic_x = true,
                  .logarithmic_y = true,
                  .series = {},
                  .floor = bench_floor(bench, observed)};
  const std::vector<bool> drawn = methods_to_draw(bench);
  for (std::size_t m = 0; m < bench.methods.size(); ++m) {
    if (!drawn[m]) continue;
    PlotSeries series{.label = bench.methods[m].spec, .points = {}};
    for (const BenchRow* row : rows_by_step(bench, m)) {
      const std::optional<double> error = error_of(*row, observed);
      if (error && !row->samples.empty())
        series.points.push_back({time_of(*row).seconds_per_time, *error});
    }
    drop_dominated(series.points);
    if (!series.points.empty()) panel.series.push_back(std::move(series));
  }
  return panel;
}

Plot bench_picture(const Bench& bench) {
  Plot plot{.panels = {}, .width = 660, .height = 500};
  for (const Observed observed : {Observed::energy, Observed::state}) {
    plot.panels.push_back(bench_panel(bench, observed));
    plot.panels.back().title = fmt::format("{}: {} error", bench.model, to_text(observed));
  }
  return plot;
}

}  // namespace hamgen::app
