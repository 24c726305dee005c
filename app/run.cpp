// hamgen run: from a model to numbers.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/event_file.hpp"
#include "app/output/progress_bars.hpp"
#include "app/output/run_report.hpp"
#include "app/output/run_rows.hpp"
#include "app/output/terminal.hpp"
#include "app/output/trajectory_plot.hpp"
#include "app/output/trajectory_table.hpp"
#include "app/run_checkpoint.hpp"
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

struct RunOptions {
  MethodOptions method;
  std::string compiler, flags;
  bool portable = false;
  bool interpret = false;
  SceneOptions scene;
  std::string every;
  std::string watch_modified;
  WatchOptions watch;
  std::string output, plot, columns;
  std::string header;
  bool certify = false;
  CheckpointOptions checkpoint;
  bool json = false;
  bool quiet = false;
};

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// The distance of records: the option, else the scene's, else 1; the last two unless that makes a
// flood of rows, as a scene's distance may with many more steps than the scene has.
long record_distance(const RunOptions& options, const SceneValues& scene) {
  constexpr long flood = 10'000'000;
  if (!options.every.empty()) return integer_value("--every " + options.every, options.every, 1);
  // What is only drawn is seen from near, and takes no more time than this many.
  constexpr long drawn = 100'000;
  if (options.output.empty()) return 1 + *scene.steps / drawn;
  const long every = scene.every.value_or(1);
  const long rows = *scene.steps / every;
  if (rows > flood)
    throw UsageError(
        fmt::format("-o {} would get {} rows\nhelp: record fewer, for example --every {}; or say "
                    "--every {} if you mean it",
                    options.output, rows, std::max(1L, *scene.steps / 10'000), every));
  return every;
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
                                  const runtime::InitialValues& start, long every) {
  std::vector<std::string> lines = {
      "made by   hamgen " HAMGEN_VERSION,
      fmt::format("model     {}   sha256 {}", plugin.model.source.path,
                  runtime::sha256_hex(plugin.model.source.text)),
      fmt::format("scheme    {}", plugin.scheme_name), fmt::format("solver    {}", plugin.solver),
      fmt::format("h         {}, {}", runtime::number_text(start.h.hi),
                  every == 0 ? "rows at given times" : fmt::format("every {}", every))};
  if (!scene.name.empty()) lines.push_back("scene     " + scene.name);
  for (const auto& [name, value] : parameter_values(plugin, scene, start))
    lines.push_back(fmt::format("parameter {} = {}", name, runtime::number_text(value)));
  return lines;
}

// Writes the emitted header if asked to; returns where it is, or how to see it.  What the run looks
// for is not in it.
std::string keep_header(const PluginSource& plugin, const SourceText& source, Request request,
                        const RunOptions& options) {
  if (options.header.empty()) return "print it with: " + request.command;
  OutputFile header = plugin.header;
  if (request.scene && !request.scene->values.watched.empty()) {
    request.scene->values.watched.clear();
    header = generate_plugin(source, request, HeaderProof::included).header;
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

std::string trajectory_text(const std::string& output, const TrajectoryTable& table) {
  return fmt::format("{}, {} rows", output == "-" ? "on standard output" : output, table.rows());
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

void check_files(const RunOptions& options) {
  if (options.json && options.output == "-")
    throw UsageError(
        "--json and -o - both write to standard output\nhelp: give the trajectory a file: -o "
        "FILE.csv");
  std::error_code missing;
  if (std::filesystem::equivalent(options.output, options.method.model, missing))
    throw UsageError(fmt::format("-o {}: that is the model; give the trajectory a file of its own",
                                 options.output));
  std::filesystem::path path = options.output;
  const bool is_picture = path.extension() == ".svg" || path.extension() == ".png";
  if (path.has_extension() && path.extension() != ".csv")
    throw UsageError(
        fmt::format("-o {}: the trajectory is written as CSV, and its name ends in .csv\nhelp: {}",
                    options.output,
                    is_picture ? "for a picture of it: --plot " + options.output
                               : "-o " + path.replace_extension(".csv").string()));
  if (!options.plot.empty()) require_picture_name("--plot", options.plot);
  check_watch(options.watch, options.output, !options.plot.empty(), !options.every.empty());
  if (!options.columns.empty() && options.plot.empty())
    throw UsageError("--columns says what is drawn\nhelp: add --plot FILE.svg");
}

void draw(const RunOptions& options, const NumberTable& rows, const RunReport& report) {
  const std::string scene = report.scene->name.empty() ? "" : " " + report.scene->name;
  const Plot plot = trajectory_plot(rows, options.columns, report.plugin->model.name + scene);
  draw_picture({.picture = options.plot,
                .script = std::filesystem::path(options.plot).replace_extension(".gp"),
                .text = gnuplot_script(plot, options.plot)},
               options.quiet, &interrupt_flag());
}

int run(const RunOptions& options) {
  check_files(options);
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
  const std::string compiler = compiler_choice(options.compiler, options.flags, options.portable);
  if (options.interpret && !compiler.empty())
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
      source, request, options.header.empty() ? HeaderProof::left_out : HeaderProof::included);
  report.plugin = &plugin;
  report.generate_seconds = seconds_since(begin);

  const runtime::LoadedPlugin loaded = options.interpret
                                           ? interpreted_integrator(source, request, plugin)
                                           : load_integrator(plugin, compiler, &interrupt_flag());
  report.interpreted = options.interpret;
  report.from_cache = loaded.from_cache;
  report.compile_seconds = loaded.compile_seconds;
  if (!options.quiet) {
    for (const std::string& warning : loaded.warnings)
      print_error(fmt::format("hamgen: warning: {}\n", warning));
  }
  const runtime::InitialValues start = initial_values(plugin, scene, *loaded.library);
  report.start = &start;
  report.header = keep_header(plugin, source, request, options);

  const std::vector<std::string> remarks = metadata(plugin, scene, start, every);
  runtime::Integrator integrator(loaded.library, start);
  std::optional<RunKeeper> keeper;
  if (options.checkpoint.is_wanted())
    keeper.emplace(options.checkpoint, manifest(options, setting, scene, plugin, every),
                   integrator);
  Columns columns = columns_of(plugin, scene, loaded.library->is_wide());
  std::optional<TrajectoryTable> kept;
  if (keeper && !options.output.empty())
    kept.emplace(keeper->table(options.output, remarks, columns));
  RunRows rows(kept ? std::move(kept) : table_of(options.output, columns, remarks),
               !options.plot.empty(), columns);
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
    report.trajectory = trajectory_text(options.output, *rows.table());
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
  add_scene_options(*parser, options->scene);
  add_observe_option(*parser, options->scene);
  parser->add_option("--h", options->scene.h, "")->type_name("H");
  parser->add_option("--steps", options->scene.steps, "")->type_name("N");
  parser
      ->add_option("--time", options->scene.time,
                   "size and number, or time, of steps; default: the scene's")
      ->type_name("T");
  parser->add_option("--every", options->every, "")->type_name("K");
  parser->add_option("--at", options->watch.at, "")->type_name("T");
  parser
      ->add_option("--every-time", options->watch.every_time,
                   "rows every K steps, or at times: --at 1,2.5")
      ->type_name("T");
  add_repeated(*parser, "--until", options->watch.until, "")->type_name("EXPR");
  parser
      ->add_option("--seconds", options->watch.seconds,
                   "ends where it crosses zero, or as r < 1, energy_error > 1e-6")
      ->type_name("S");
  parser->add_option("-o,--output", options->output, "")->type_name("FILE");
  parser
      ->add_option("--plot", options->plot,
                   "the trajectory: .csv, - is stdout; a picture: .svg, .png")
      ->type_name("FILE");
  parser->add_option("--columns", options->columns, "")->type_name("LIST");
  parser
      ->add_option("--events", options->watch.events,
                   "drawn: q, q:p, x:y:z; what the events saw: .csv, .json")
      ->type_name("FILE");
  add_checkpoint_options(*parser, options->checkpoint);
  add_checkpoint_interval(*parser, options->checkpoint);
  parser->add_flag("--certify", options->certify, "default 60; how near it is to the exact map");
  parser->add_option("--watch-modified", options->watch_modified, "")->type_name("K");
  parser->add_flag("--interpret", options->interpret,
                   "terms of the modified Hamiltonian; without a compiler");
  parser->add_flag("--json", options->json, "");
  parser->add_flag("--quiet", options->quiet, "");
  parser->add_option("--header", options->header, "as JSON; no summary; the emitted header")
      ->type_name("DIR");
  add_method_options(*parser, options->method);
  parser->add_option("--compiler", options->compiler, "")->type_name("C");
  parser->add_option("--flags", options->flags, "")->type_name("F");
  parser->add_flag("--portable", options->portable,
                   "default: $CXX, g++, clang++; not for this processor alone");
  return {parser, [options] { return run(*options); }};
}

}  // namespace hamgen::app
