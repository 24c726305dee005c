#include "app/output/report_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studies/initial_data.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

constexpr long kPortraitSteps = 5000;
constexpr long kZoomSteps = 400;
constexpr long kBins = 800;             // of the energy error over all the time
constexpr std::size_t kBodies = 8;      // colours
constexpr int kTrack = 40;              // times at which the state error is looked at
constexpr double kTrackSeconds = 20.0;  // for the reference at these times

runtime::InitialValues starting_values(const BenchMethod& method, const SceneValues& scene) {
  return initial_values(method.plugin, scene, *method.loaded.library);
}

// The states after each of the first steps, up to a failure, of all degrees of freedom.
std::vector<std::vector<double>> orbit(const BenchMethod& method, const SceneValues& scene,
                                       const runtime::InitialValues& start, long steps) {
  std::vector<std::vector<double>> states;
  runtime::Integrator integrator(method.loaded.library, start);
  runtime::IntegrateOptions options;
  options.steps = steps;
  options.every = 1;
  options.on_record = [&](const runtime::Record& record) {
    states.push_back(
        rounded(whole_state(method.plugin, scene, {record.state.begin(), record.state.end()})));
  };
  static_cast<void>(runtime::integrate(integrator, options));
  return states;
}

PlotSeries path(const std::vector<std::vector<double>>& states, std::size_t x, std::size_t y,
                int colour) {
  PlotSeries series{.style = PlotStyle::lines, .colour = colour};
  for (const std::vector<double>& state : states) series.points.push_back({state[x], state[y]});
  return series;
}

// The bodies' paths where the first two coordinates are arrays of the same range, else the first
// two coordinates.
Figure orbit_picture(const Model& model, const std::vector<std::vector<double>>& states,
                     const std::string& what) {
  const auto& coordinates = model.coordinates;
  const bool bodies = coordinates.size() > 1 && coordinates[0].range && coordinates[1].range &&
                      coordinates[0].range->size() == coordinates[1].range->size();
  const std::vector<std::string> names = element_names(coordinates);
  const std::size_t count =
      bodies ? static_cast<std::size_t>(coordinates[0].range->size()) : std::size_t{1};
  const std::string x = bodies ? coordinates[0].name : names[0];
  const std::string y = bodies ? coordinates[1].name : names[1];
  const auto is_time = [&](const std::string& name) {
    return std::ranges::any_of(model.coordinates, [&](const Variable& variable) {
      return variable.is_time && variable.name == name;
    });
  };
  PlotPanel plane{.x_label = x, .y_label = y, .square = !is_time(x) && !is_time(y)};
  for (std::size_t i = 0; i < std::min(count, kBodies); ++i)
    plane.series.push_back(path(states, i, bodies ? count + i : 1, static_cast<int>(i)));
  const std::string shown = count > kBodies ? fmt::format(" of the first {} bodies", kBodies)
                            : bodies        ? fmt::format(" of the {} bodies", count)
                                            : "";
  return {"orbit",
          fmt::format("The orbit{} in {} and {}: {}.", shown, x, y, what),
          {.panels = {plane}}};
}

// One degree of freedom: the scene's orbit among those that start nearer to the origin.  More: the
// first two coordinates, and the first coordinate with its momentum.
std::vector<Figure> portraits(const BenchMethod& method, const SceneValues& scene) {
  const Model& model = method.plugin.model;
  const std::vector<std::string> q = element_names(model.coordinates);
  const std::vector<std::string> p = element_names(model.momenta);
  const runtime::InitialValues start = starting_values(method, scene);
  const long steps = std::min(*scene.steps, kPortraitSteps);
  const auto states = orbit(method, scene, start, steps);
  const std::size_t n = q.size();
  const std::string what =
      fmt::format("the first {} steps of h = {}", steps, runtime::number_text(to_double(*scene.h)));
  PlotPanel phase{.x_label = q.front(), .y_label = p.front()};
  std::string caption = fmt::format("Phase portrait: {}.", what);
  if (n == 1) {
    for (const double factor : {0.25, 0.5, 0.75}) {
      runtime::InitialValues smaller = start;
      for (runtime::Wide& value : smaller.state) value = {.hi = factor * value.hi};
      phase.series.push_back(path(orbit(method, scene, smaller, steps), 0, 1, 6));
    }
    caption += " In light blue orbits from 1/4, 1/2 and 3/4 of the initial state.";
  }
  phase.series.push_back(path(states, 0, n, 0));
  std::vector<Figure> figures = {{"portrait", caption, {.panels = {phase}}}};
  if (n > 1) figures.insert(figures.begin(), orbit_picture(model, states, what));
  return figures;
}

// Least and greatest error of each bin, in turn: a band where the energy oscillates.
Figure energy_over_time(const BenchMethod& method, const SceneValues& scene,
                        OrbitSummary& summary) {
  runtime::Integrator integrator(method.loaded.library, starting_values(method, scene));
  const runtime::Wide initial = integrator.energy();
  const double h = to_double(*scene.h);
  const long bin = std::max(1L, *scene.steps / kBins);
  PlotSeries series{.style = PlotStyle::lines};
  runtime::EnergyStatistics energy{
      .initial = initial, .min = initial, .max = initial, .last = initial};
  runtime::RunSummary& run = summary.run;
  while (run.steps_done < *scene.steps && run.status == runtime::Status::done &&
         !is_stopped(method.stop)) {
    const runtime::Report report =
        integrator.advance(std::min(bin, *scene.steps - static_cast<long>(run.steps_done)), true);
    run.status = report.status;
    run.steps_done += report.steps_done;
    run.iterations += report.iterations;
    if (!report.energy) continue;
    energy.min = std::min(energy.min, report.energy->min);
    energy.max = std::max(energy.max, report.energy->max);
    energy.last = report.energy->last;
    const double time = h * static_cast<double>(run.steps_done);
    series.points.push_back({time, difference(report.energy->min, initial)});
    series.points.push_back({time, difference(report.energy->max, initial)});
  }
  run.energy = energy;
  summary.scalar_digits = method.loaded.library->plugin().scalar_digits;
  summary.outcome =
      run.status == runtime::Status::done
          ? "done"
          : fmt::format("{} in step {}", runtime::to_text(run.status), run.steps_done + 1);
  return {"energy",
          fmt::format("Energy error over all {} steps: least and greatest of each {}.",
                      run.steps_done, bin),
          {.panels = {{.x_label = "t", .y_label = "H - H(0)", .series = {series}}}}};
}

Figure energy_at_first(const BenchMethod& method, const SceneValues& scene) {
  runtime::Integrator integrator(method.loaded.library, starting_values(method, scene));
  runtime::IntegrateOptions options;
  options.steps = std::min(*scene.steps, kZoomSteps);
  options.every = 1;
  PlotSeries series{.style = PlotStyle::lines};
  const runtime::Wide initial = integrator.energy();
  options.on_record = [&](const runtime::Record& record) {
    series.points.push_back({record.time, difference(record.energy, initial)});
  };
  static_cast<void>(runtime::integrate(integrator, options));
  return {"energy_zoom",
          fmt::format("The same, step by step, over the first {} steps.", options.steps),
          {.panels = {{.x_label = "t", .y_label = "H - H(0)", .series = {series}}}}};
}

PlotSeries error_over_time(const BenchMethod& method, const SceneValues& scene, long chunk,
                           const std::vector<std::vector<runtime::Wide>>& track) {
  PlotSeries series{.label = method.spec, .style = PlotStyle::lines};
  runtime::Integrator integrator(method.loaded.library, starting_values(method, scene));
  double time = 0.0;
  for (const std::vector<runtime::Wide>& exact : track) {
    if (integrator.advance(chunk, false).status != runtime::Status::done) break;
    time += to_double(*scene.h) * static_cast<double>(chunk);
    series.points.push_back(
        {time,
         distance(known_state(method.plugin, whole_state(method.plugin, scene, integrator.state())),
                  known_state(method.plugin, exact))});
  }
  return series;
}

Figure state_over_time(const SceneValues& scene, const SourceText& source, const Bench& bench,
                       const ReferenceRequest& request) {
  const long steps = std::min(*scene.steps, std::lround(bench.time / to_double(*scene.h)));
  const long chunk = std::max(1L, steps / kTrack);
  const int count = static_cast<int>(std::min<long>(kTrack, steps / chunk));
  std::vector<Rational> times;
  for (int i = 1; i <= count; ++i) times.push_back(*scene.h * chunk * i);
  const ReferenceRule rule = reference_rule(source, request);
  const auto track = reference_track(rule, initial_values(rule.plugin, scene, *rule.loaded.library),
                                     times, kTrackSeconds, request.stop)
                         .states;
  PlotPanel panel{.x_label = "t", .y_label = "|z - z*|", .logarithmic_y = true};
  for (const BenchMethod& method : bench.methods) {
    if (method.refusal.empty())
      panel.series.push_back(error_over_time(method, scene, chunk, track));
  }
  return {"state",
          fmt::format("Distance from the reference solution over time, every method with h = {}.",
                      runtime::number_text(to_double(*scene.h))),
          {.panels = {panel}, .width = 600}};
}

}  // namespace

ReportFigures report_figures(const BenchMethod& method, const SceneValues& scene,
                             const SourceText& source, const Bench& bench,
                             const ReferenceRequest& request) {
  ReportFigures result;
  result.figures = portraits(method, scene);
  result.figures.push_back(energy_over_time(method, scene, result.orbit));
  result.figures.push_back(energy_at_first(method, scene));
  if (!bench.reference.state.empty())
    result.figures.push_back(state_over_time(scene, source, bench, request));
  const Plot both = picture_of(bench);
  const std::vector<std::pair<std::string, std::string>> names = {
      {"bench_energy", "Energy error against run time: one point a step size."},
      {"bench_state", "State error at the end against run time."}};
  for (std::size_t i = 0; i < both.panels.size(); ++i) {
    PlotPanel panel = both.panels[i];
    panel.title.clear();
    if (i == 1 && bench.reference.state.empty()) continue;
    result.figures.push_back(
        {names[i].first, names[i].second, {.panels = {std::move(panel)}, .width = 600}});
  }
  return result;
}

}  // namespace hamgen::app
