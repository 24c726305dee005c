#include "app/output/report_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/output/bench_picture.hpp"
#include "app/output/envelope.hpp"
#include "app/output/math_symbol.hpp"
#include "app/output/plain_number.hpp"
#include "app/output/report_orbit.hpp"
#include "app/studies/initial_data.hpp"

namespace hamgen::app {
namespace {

constexpr long kZoomSteps = 1000;
constexpr long kBins = 400;             // of the energy error over all the time
constexpr int kTrack = 40;              // times at which the state error is looked at
constexpr double kTrackSeconds = 20.0;  // for the reference at these times
constexpr double kHalfUnit = std::numeric_limits<double>::epsilon() / 2;

constexpr int kSmallWidth = 440;
constexpr int kSmallHeight = 350;
constexpr const char* kEnergyLabel = "(H − H(0)) / scale";

// With room for the names of the curves.
int small_height(const PlotPanel& panel) {
  constexpr int row = 17;
  return kSmallHeight + 10 + row * legend_rows(panel, kSmallWidth);
}

runtime::InitialValues start_of_figure(const BenchMethod& method, const SceneValues& scene) {
  return initial_values(method.plugin, scene, *method.loaded.library);
}

// What is 0 has no scale: its errors are as they are.
double unit_of(double scale) { return scale > 0.0 ? scale : 1.0; }

// A conserved quantity, and its largest error so far after each bin.
struct Watched {
  std::size_t place = 0;  // among the plugin's invariants
  double initial = 0.0;
  double unit = 1.0;
  PlotSeries series;
};

std::vector<Watched> watched_invariants(const BenchMethod& method,
                                        const runtime::Integrator& integrator) {
  constexpr double zero = 1e-6;  // below, an error relative to the value says nothing
  constexpr std::size_t most = 6;
  std::vector<Watched> all;
  const std::vector<runtime::Wide> values = integrator.invariants();
  for (std::size_t i = 0; i < values.size() && all.size() < most; ++i) {
    const std::string& name = method.plugin.invariant_names[i];
    const bool is_conserved =
        std::ranges::find(method.plugin.model.invariants, name, &Invariant::name) !=
        method.plugin.model.invariants.end();
    if (!is_conserved || !std::isfinite(values[i].hi)) continue;
    const double size = std::fabs(values[i].hi);
    all.push_back({.place = i,
                   .initial = values[i].hi,
                   .unit = size > zero ? size : 1.0,
                   .series = {.label = plain_symbol(name) + (size > zero ? "" : " (absolute)"),
                              .points = {},
                              .style = PlotStyle::lines}});
  }
  return all;
}

void add_error(PlotSeries& series, double time, double error) {
  const double before = series.points.empty() ? 0.0 : series.points.back().y;
  series.points.push_back({time, std::max(before, error)});
}

// All the scene's steps, in bins.
class EnergyWatch {
 public:
  explicit EnergyWatch(const ReportSubject& subject)
      : method_(*subject.method),
        scene_(*subject.scene),
        integrator_(method_.loaded.library, start_of_figure(method_, scene_)),
        initial_(integrator_.energy()),
        invariants_(watched_invariants(method_, integrator_)),
        bin_(std::max(1L, *scene_.steps / kBins)) {
    summary_.run.energy = {.initial = initial_, .min = initial_, .max = initial_, .last = initial_};
    summary_.run.energy_terms = integrator_.judge().energy_terms();
    unit_ = unit_of(summary_.run.energy_terms);
    band_.points.push_back({0.0, 0.0, 0.0});
    while (advance()) {
    }
    summary_.scalar_digits = method_.loaded.library->plugin().scalar_digits;
    const runtime::RunSummary& run = summary_.run;
    summary_.outcome =
        run.status == runtime::Status::done
            ? "done"
            : fmt::format("{} in step {}", runtime::to_text(run.status), run.steps_done + 1);
  }

  [[nodiscard]] const OrbitSummary& summary() const { return summary_; }
  [[nodiscard]] bool shows_each_step() const { return bin_ == 1; }
  [[nodiscard]] Figure energy() const {
    const PlotSeries each{
        .label = "", .points = band_.points, .style = PlotStyle::lines, .colour = 0};
    const char* const what = bin_ > 1 ? "between its least and its greatest" : "after each step";
    return {.name = "energy",
            .caption = fmt::format("Energy error over all {} steps, {}, of the scale {}.",
                                   summary_.run.steps_done, what,
                                   plain_number(summary_.run.energy_terms, 3)),
            .plot = {.panels = {{.title = "",
                                 .x_label = "t",
                                 .y_label = kEnergyLabel,
                                 .series = bin_ > 1 ? envelope(band_) : std::vector{each}}},
                     .width = kSmallWidth,
                     .height = kSmallHeight}};
  }
  // Empty where the model names no invariants.
  [[nodiscard]] std::vector<Figure> conserved() const {
    if (invariants_.empty()) return {};
    PlotPanel panel{.title = "",
                    .x_label = "t",
                    .y_label = "largest relative error so far",
                    .logarithmic_x = true,
                    .logarithmic_y = true,
                    .series = {largest_},
                    .floor = kHalfUnit};
    for (const Watched& each : invariants_) panel.series.push_back(each.series);
    return {{.name = "conserved",
             .caption =
                 "What is conserved: the largest error so far of the energy, of its scale, and of "
                 "the invariants, of their values at the start.",
             .plot = {.panels = {panel}, .width = kSmallWidth, .height = kSmallHeight}}};
  }

 private:
  bool advance() {
    runtime::RunSummary& run = summary_.run;
    const long left = *scene_.steps - static_cast<long>(run.steps_done);
    if (left == 0 || run.status != runtime::Status::done || is_stopped(method_.stop)) return false;
    const runtime::Report report = integrator_.advance(std::min(bin_, left), true);
    run.status = report.status;
    run.steps_done += report.steps_done;
    run.iterations += report.iterations;
    const double time = to_double(*scene_.h) * static_cast<double>(run.steps_done);
    if (!report.energy) return true;
    run.energy->min = std::min(run.energy->min, report.energy->min);
    run.energy->max = std::max(run.energy->max, report.energy->max);
    run.energy->last = report.energy->last;
    const double low = difference(report.energy->min, initial_) / unit_;
    const double high = difference(report.energy->max, initial_) / unit_;
    band_.points.push_back({time, high, low});
    add_error(largest_, time, std::max(std::fabs(low), std::fabs(high)));
    if (invariants_.empty()) return true;
    const std::vector<runtime::Wide> values = integrator_.invariants();
    for (Watched& each : invariants_)
      add_error(each.series, time, std::fabs(values[each.place].hi - each.initial) / each.unit);
    return true;
  }

  const BenchMethod& method_;
  const SceneValues& scene_;
  runtime::Integrator integrator_;
  runtime::Wide initial_;
  std::vector<Watched> invariants_;
  long bin_;
  double unit_ = 1.0;
  OrbitSummary summary_;
  PlotSeries band_ = {.label = "", .points = {}, .style = PlotStyle::band, .colour = 0};
  PlotSeries largest_ = {.label = "H", .points = {}, .style = PlotStyle::lines};
};

Figure energy_at_first(const ReportSubject& subject, double scale) {
  const BenchMethod& method = *subject.method;
  runtime::Integrator integrator(method.loaded.library, start_of_figure(method, *subject.scene));
  runtime::IntegrateOptions options;
  options.steps = std::min(*subject.scene->steps, kZoomSteps);
  options.every = 1;
  PlotSeries series{.label = "", .points = {}, .style = PlotStyle::lines};
  const runtime::Wide initial = integrator.energy();
  options.on_record = [&](const runtime::Record& record) {
    series.points.push_back({record.time, difference(record.energy, initial) / unit_of(scale)});
  };
  static_cast<void>(runtime::integrate(integrator, options));
  return {
      .name = "energy_zoom",
      .caption = fmt::format("The same, step by step, over the first {} steps.", options.steps),
      .plot = {
          .panels = {{.title = "", .x_label = "t", .y_label = kEnergyLabel, .series = {series}}},
          .width = kSmallWidth,
          .height = kSmallHeight}};
}

PlotSeries error_over_time(const BenchMethod& method, const SceneValues& scene, long chunk,
                           const std::vector<std::vector<runtime::Wide>>& track) {
  PlotSeries series{.label = method.spec, .points = {}, .style = PlotStyle::lines};
  runtime::Integrator integrator(method.loaded.library, start_of_figure(method, scene));
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
                       const ReferenceRequest& request, const std::optional<double>& floor) {
  const long steps = std::min(*scene.steps, std::lround(bench.time / to_double(*scene.h)));
  const long chunk = std::max(1L, steps / kTrack);
  const int count = static_cast<int>(std::min<long>(kTrack, steps / chunk));
  std::vector<Rational> times;
  for (int i = 1; i <= count; ++i) times.push_back(*scene.h * chunk * i);
  const ReferenceRule rule = reference_rule(source, request);
  const auto track = reference_track(rule, initial_values(rule.plugin, scene, *rule.loaded.library),
                                     times, kTrackSeconds, request.stop)
                         .states;
  PlotPanel panel{.title = "",
                  .x_label = "t",
                  .y_label = "|z − z*|",
                  .logarithmic_y = true,
                  .series = {},
                  .floor = floor};
  const std::vector<bool> drawn = methods_to_draw(bench);
  for (std::size_t m = 0; m < bench.methods.size(); ++m) {
    const BenchMethod& method = bench.methods[m];
    if (drawn[m] && method.refusal.empty())
      panel.series.push_back(error_over_time(method, scene, chunk, track));
  }
  return {.name = "state",
          .caption = "Distance from the reference solution over time, each with this page's step.",
          .plot = {.panels = {panel}, .width = kSmallWidth, .height = small_height(panel)}};
}

// The method of the page at the scene's step among the others.
void add_subject(const ReportSubject& subject, Observed observed, PlotPanel& panel) {
  const std::optional<double> error = error_of(subject.row, observed);
  if (!error || subject.row.samples.empty()) return;
  panel.series.push_back({.label = "this page's step",
                          .points = {{time_of(subject.row).seconds_per_time, *error}},
                          .style = PlotStyle::mark,
                          .colour = 4});
}

Figure errors_against_time(const ReportSubject& subject, const Bench& bench, Observed observed,
                           bool large) {
  PlotPanel panel = bench_panel(bench, observed);
  add_subject(subject, observed, panel);
  const bool is_energy = observed == Observed::energy;
  const int height = large ? 560 : small_height(panel);
  return {
      .name = is_energy ? "bench_energy" : "bench_state",
      .caption = is_energy ? "Energy error against run time: one point a step size."
                           : "State error at the end against run time: one point a step size; "
                             "further left and further down is better.",
      .plot = {.panels = {std::move(panel)}, .width = large ? 1000 : kSmallWidth, .height = height},
      .large = large};
}

}  // namespace

ReportFigures report_figures(const ReportSubject& subject, const SourceText& source,
                             const Bench& bench, const ReferenceRequest& request) {
  const bool has_reference = !bench.reference.state.empty();
  ReportFigures result;
  std::vector<Figure>& figures = result.figures;
  figures.push_back(errors_against_time(subject, bench,
                                        has_reference ? Observed::state : Observed::energy, true));
  const std::optional<double> floor = figures.front().plot.panels.front().floor;
  std::ranges::move(orbit_figures(*subject.method, *subject.scene), std::back_inserter(figures));
  const EnergyWatch watch(subject);
  result.orbit = watch.summary();
  figures.push_back(watch.energy());
  if (!watch.shows_each_step())
    figures.push_back(energy_at_first(subject, result.orbit.run.energy_terms));
  std::ranges::move(watch.conserved(), std::back_inserter(figures));
  if (!has_reference) return result;
  figures.push_back(state_over_time(*subject.scene, source, bench, request, floor));
  // The last one is large where it would stand alone in its row.
  const auto small = std::ranges::count(figures, false, &Figure::large);
  figures.push_back(errors_against_time(subject, bench, Observed::energy, small % 2 == 0));
  return result;
}

}  // namespace hamgen::app
