// hamgen run: from a model to numbers.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/event_file.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress_bars.hpp"
#include "app/output/run_report.hpp"
#include "app/output/run_rows.hpp"
#include "app/output/terminal.hpp"
#include "app/output/trajectory_plot.hpp"
#include "app/output/trajectory_table.hpp"
#include "app/run_checkpoint.hpp"
#include "app/run_options.hpp"
#include "app/run_watch.hpp"
#include "app/studies/certify.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/interpreted.hpp"
#include "app/studies/load_integrator.hpp"
#include "app/studies/manifest.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/load_plugin.hpp"
#include "runtime/progress.hpp"
#include "runtime/sha256.hpp"

namespace hamgen::app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// q then p.
std::vector<std::string> state_names(const Model& model) {
  std::vector<std::string> names = element_names(model.coordinates);
  std::ranges::move(element_names(model.momenta), std::back_inserter(names));
  return names;
}

Columns columns_of(const PluginSource& plugin, const SceneValues& scene, bool wide) {
  Columns columns;
  columns.wide = wide;
  const bool parts = observes_parts(plugin.model, scene);
  const std::vector<std::string> state = state_names(plugin.model);
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (parts && !observes(scene, state[i])) continue;
    columns.state.push_back(state[i]);
    columns.state_places.push_back(i);
  }
  columns.energy = observes(scene, "energy");
  columns.has_time = std::ranges::any_of(plugin.model.coordinates, &Variable::is_time);
  for (std::size_t i = 0; i < plugin.invariant_names.size(); ++i) {
    if (!observes(scene, plugin.invariant_names[i])) continue;
    if (is_watched(scene, plugin.invariant_names[i])) continue;
    columns.invariants.push_back(plugin.invariant_names[i]);
    columns.places.push_back(i);
  }
  return columns;
}

std::vector<std::string> metadata(const PluginSource& plugin, const SceneValues& scene,
                                  const runtime::InitialValues& start, long every,
                                  std::optional<double> energy_scale) {
  std::vector<std::string> lines = {
      "made by   hamgen " HAMGEN_VERSION,
      fmt::format("model     {}   sha256 {}", plugin.model.source.path,
                  runtime::sha256_hex(plugin.model.source.text)),
      fmt::format("scheme    {}", plugin.scheme_name), fmt::format("solver    {}", plugin.solver),
      fmt::format("h         {}, {}", runtime::number_text(start.h.hi),
                  every == 0 ? "rows at given times" : fmt::format("every {}", every))};
  if (!scene.name.empty()) lines.push_back("scene     " + scene.name);
  if (energy_scale) lines.push_back(energy_scale_remark(*energy_scale));
  for (const auto& [name, value] : parameter_values(plugin, scene, start))
    lines.push_back(fmt::format("parameter {} = {}", name, runtime::number_text(value)));
  return lines;
}

// What the errors of the column of energies are compared with.
std::optional<double> scale_of(const runtime::Integrator& integrator, const Columns& columns) {
  const double scale = integrator.judge().energy_terms();
  return columns.energy && std::isfinite(scale) && scale > 0.0 ? std::optional(scale)
                                                               : std::nullopt;
}

// Writes the emitted header if asked to; returns where it is, or how to see it.  What the run looks
// for is not in it.
std::string keep_header(const PluginSource& plugin, const SourceText& source, Request request,
                        const RunOptions& options) {
  if (options.header.empty()) return "print it with: " + request.command;
  OutputFile header = plugin.header;
  if (request.scene && !request.scene->values.watched.empty()) {
    request.scene->values.watched.clear();
    header = generate_plugin(source, request, HeaderText::with_proof).header;
  }
  const std::filesystem::path path = std::filesystem::path(options.header) / header.path;
  runtime::atomic_write(path, header.text);
  return path.string();
}

std::optional<TrajectoryTable> table_of(const std::string& output, const Columns& columns,
                                        const std::vector<std::string>& remarks) {
  if (output.empty()) return std::nullopt;
  return std::optional<TrajectoryTable>(std::in_place, output, remarks, columns);
}

// `is_kept`: for a run that goes on from its checkpoint.
std::string trajectory_text(const std::string& output, const TrajectoryTable& table, bool is_kept) {
  const std::string rows = fmt::format("{} rows", table.rows());
  if (is_kept) return fmt::format("{0}.part, {1}; {0} at the end of the run", output, rows);
  return fmt::format("{}, {}", output == "-" ? "on standard output" : output, rows);
}

int status_of(const RunReport& report) {
  const runtime::RunSummary& summary = report.summary;
  switch (summary.status) {
    case runtime::Status::done:
      if (interrupt_flag() && report.certificate) return interrupted;
      if (!missed_ends(report).empty()) return numerical_failure;
      return report.certificate && !report.certificate->holds() ? numerical_failure : done;
    case runtime::Status::stopped:
      return interrupted;
    case runtime::Status::out_of_time:
      return ran_out_of_time;
    case runtime::Status::jumped:
    case runtime::Status::escaped:
    case runtime::Status::not_converged:
    case runtime::Status::left_domain:
    case runtime::Status::overflow:
    case runtime::Status::undefined:
      return numerical_failure;
  }
  internal_error("no such status");
}

// What the rows and the numbers of this run depend on.
std::vector<std::string> manifest(const RunOptions& options, const Setting& setting,
                                  const SceneValues& scene, const PluginSource& plugin,
                                  long every) {
  std::vector<std::string> lines = manifest_lines(setting, scene, plugin, options.compiler);
  if (!options.output.empty()) lines.push_back(fmt::format("rows      every {} steps", every));
  return lines;
}

// It ended before its end, in good order.
bool has_steps_left(runtime::Status status) {
  return status == runtime::Status::stopped || status == runtime::Status::out_of_time;
}

void say(const RunReport& report, const RunOptions& options) {
  if (!options.quiet) print_error(summary_text(report));
  const std::string failure = failure_text(report);
  if (!failure.empty()) print_error("hamgen: " + failure + "\n");
  if (failure.empty()) {
    for (const std::string& missed : missed_ends(report))
      print_error(
          fmt::format("hamgen: {}\nhelp: more steps, --steps N, or another condition\n", missed));
  }
  if (report.watch->rows_missed() > 0)
    print_error(
        fmt::format("hamgen: warning: {} rows are missing: a step of part of the length failed\n",
                    report.watch->rows_missed()));
  if (failed_in_a_step(report.summary.status))
    print_error(fmt::format("help: the state stays the last good one; try a smaller step, --h {}\n",
                            runtime::number_text(report.start->h.hi / 4.0)));
  if (options.json) print(json_text(report));
}

void draw(const RunOptions& options, const NumberTable& rows, const RunReport& report) {
  const std::string scene = report.scene->name.empty() ? "" : ", scene " + report.scene->name;
  const Plot plot = trajectory_plot(rows, options.columns, report.plugin->model.name + scene);
  draw_picture({.picture = options.plot,
                .script = std::filesystem::path(options.plot).replace_extension(".gp"),
                .text = gnuplot_script(plot, options.plot)},
               options.quiet, &interrupt_flag());
}

int run(const RunOptions& options) {
  require_run_files(options);
  require_file("-o", options.output);
  require_file("--events", options.watch.events);
  require_writable({options.plot});
  Setting setting = read_setting(options.method, options.scene);
  const SourceText& source = setting.source;
  const Model& model = setting.model;
  Request& request = setting.request;
  if (!model.warnings.empty() && !options.quiet) print_error(render(model.warnings, source));
  SceneValues scene = complete_scene(model, setting.scene);
  std::vector<WatchedEvent> events = watched_events(options.watch, model, scene);
  const RowTimes times = row_times(options.watch, scene);
  require_to_be_kept(options.checkpoint, options.output,
                     !events.empty() || !times.empty() || !options.plot.empty());
  const long every = times.empty() ? record_distance(options, scene) : 0;
  take_gauge_at(scene, model, request);
  specialise(options.scene, scene, {}, Observing::as_the_scene, setting);
  // The exact map is that of all degrees of freedom.
  if (request.scene) request.scene->sees_all = options.certify;
  if (options.interpret && !options.watch_modified.empty())
    throw UsageError(
        "--interpret does not know the modified Hamiltonian: leave out one of the two");
  if (options.interpret && options.compiler != CompilerChoice())
    throw UsageError(
        "--interpret needs no --compiler, --flags and --portable: leave out one of the two");
  if (!options.watch_modified.empty()) {
    request.watch_modified = modified_term_count("--watch-modified", options.watch_modified);
    request.step = *scene.h;
  }
  record_origin(options.method, source, request);

  std::optional<Scheme> scheme;
  if (options.certify) {
    scheme = request_scheme(source, request);
    require_certifiable(request, model, *scheme);
  }

  RunReport report;
  report.path = options.method.model;
  report.scene = &scene;
  const Clock::time_point begin = Clock::now();
  const PluginSource plugin = generate_plugin(
      source, request, options.header.empty() ? HeaderText::none : HeaderText::with_proof);
  report.plugin = &plugin;
  report.generate_seconds = seconds_since(begin);

  const runtime::LoadedPlugin loaded =
      options.interpret ? interpreted_integrator(source, request, plugin)
                        : load_integrator(plugin, options.compiler, &interrupt_flag(),
                                          static_cast<double>(*scene.steps));
  report.interpreted = options.interpret;
  report.from_cache = loaded.from_cache;
  report.optimisation = loaded.optimisation;
  report.compile_seconds = loaded.compile_seconds;
  if (!options.quiet) {
    for (const std::string& warning : loaded.warnings)
      print_error(fmt::format("hamgen: warning: {}\n", warning));
  }
  const runtime::InitialValues start = initial_values(plugin, scene, *loaded.library);
  report.start = &start;
  report.header = keep_header(plugin, source, request, options);

  const Columns columns = columns_of(plugin, scene, loaded.library->is_wide());
  if (!options.columns.empty()) require_columns(column_names(columns), options.columns);
  runtime::Integrator integrator(loaded.library, start);
  const std::optional<double> energy_scale = scale_of(integrator, columns);
  const std::vector<std::string> remarks = metadata(plugin, scene, start, every, energy_scale);
  make_directories_above({options.output, options.plot, options.watch.events}, options.quiet);
  std::optional<RunKeeper> keeper;
  if (options.checkpoint.is_wanted())
    keeper.emplace(options.checkpoint, manifest(options, setting, scene, plugin, every),
                   integrator);
  std::optional<TrajectoryTable> kept;
  if (keeper && !options.output.empty())
    kept.emplace(keeper->table(options.output, remarks, columns));
  RunRows rows(kept ? std::move(kept) : table_of(options.output, columns, remarks),
               !options.plot.empty(), columns, energy_scale);
  report.scalar_digits = loaded.library->plugin().scalar_digits;
  report.initial_invariants = integrator.invariants();
  runtime::ProgressBar bar(plugin.model.name);
  runtime::IntegrateOptions integrate_options;
  integrate_options.steps = *scene.steps;
  integrate_options.every = rows.wanted() ? every : 0;
  integrate_options.watch_energy = watches_energy(plugin, scene);
  integrate_options.end_at_jump = integrate_options.watch_energy;
  integrate_options.stop = &interrupt_flag();
  integrate_options.seconds = report.seconds = seconds_of(options.watch);
  const auto add_row = [&](runtime::Record record) {
    const std::vector<runtime::Wide> state =
        whole_state(plugin, scene, {record.state.begin(), record.state.end()});
    record.state = state;
    rows.add(record);
  };
  if (rows.wanted() && times.empty()) integrate_options.on_record = add_row;
  const auto add_point = [&](const WatchedPoint& point) {
    add_row(record_of(point, *loaded.library, start,
                      loaded.library->invariants(start.parameters, point.state)));
  };
  find_places(events, plugin);
  require_energy(events, integrate_options.watch_energy);
  report.events = &events;
  std::optional<EventFile> event_file;
  if (!options.watch.events.empty())
    event_file.emplace(options.watch.events, remarks, state_names(model),
                       loaded.library->is_wide());
  OrbitWatch watch({.library = loaded.library,
                    .start = start,
                    .h = *scene.h,
                    .events = events,
                    .times = times,
                    .on_row = add_point,
                    .on_event = [&](std::size_t event, const WatchedPoint& point) {
                      if (event_file && !events[event].ends_run)
                        event_file->add(events[event].what.event.name, point,
                                        whole_state(plugin, scene, point.state));
                    }});
  report.watch = &watch;
  if (!events.empty() || !times.empty())
    integrate_options.on_look = [&watch](const auto& now) { return watch.look(now); };
  if (!options.quiet)
    integrate_options.on_progress = [&bar](const auto& progress) { bar.update(progress); };
  if (keeper) keeper->prepare(integrate_options, rows.table());
  report.summary = runtime::integrate(integrator, integrate_options);
  if (failed_in_a_step(report.summary.status)) {
    watch.look_into_failed_step(integrator);
    if (watch.ending()) report.summary.status = runtime::Status::done;
  }
  bar.remove();

  if (scheme && report.summary.steps_done > 0 && !interrupt_flag()) {
    SceneValues taken = scene;
    taken.steps = report.summary.steps_done;
    report.certificate = certify({.plugin = &plugin,
                                  .library = loaded.library,
                                  .scene = &taken,
                                  .scheme = &*scheme,
                                  .start = &start,
                                  .on_progress = progress_bars(options.quiet),
                                  .stop = &interrupt_flag()});
  }
  const std::vector<runtime::Wide> last =
      watch.ending() ? watch.ending()->second.state : integrator.state();
  report.state = whole_state(plugin, scene, last);
  report.final_invariants = loaded.library->invariants(start.parameters, last);
  if (watch.ending() && rows.wanted() && rows.time() != watch.ending()->second.time)
    add_point(watch.ending()->second);
  const bool is_kept = keeper && has_steps_left(report.summary.status);
  if (rows.table()) {
    if (!is_kept) rows.table()->publish(outcome_text(report));
    report.trajectory = trajectory_text(options.output, *rows.table(), is_kept);
  }
  if (keeper && !is_kept) keeper->remove();
  if (event_file) event_file->publish(outcome_text(report));
  say(report, options);
  if (rows.drawn()) draw(options, *rows.drawn(), report);
  if (is_kept) print_error(keeper->stopped_text());
  return status_of(report);
}

}  // namespace

Command add_run(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* parser =
      app.add_subcommand("run", "integrates a scene of a model: emits, compiles, loads and runs");
  add_run_options(*parser, *options);
  return {parser, [options] { return run(*options); }};
}

}  // namespace hamgen::app
