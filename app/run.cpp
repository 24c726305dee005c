// hamgen run: from a model to numbers.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/progress_bars.hpp"
#include "app/output/run_report.hpp"
#include "app/output/terminal.hpp"
#include "app/output/trajectory_table.hpp"
#include "app/studies/certify.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/interpreted.hpp"
#include "app/studies/load_integrator.hpp"
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
  std::string output;
  std::string header;
  bool certify = false;
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
  const long every = scene.every.value_or(1);
  const long rows = *scene.steps / every;
  if (!options.output.empty() && rows > flood)
    throw UsageError(
        fmt::format("-o {} would get {} rows\nhelp: record fewer, for example --every {}; or say "
                    "--every {} if you mean it",
                    options.output, rows, std::max(1L, *scene.steps / 10'000), every));
  return every;
}

Columns columns_of(const PluginSource& plugin, const SceneValues& scene, bool wide) {
  Columns columns;
  columns.wide = wide;
  const bool parts = observes_parts(plugin.model, scene);
  std::vector<std::string> state = element_names(plugin.model.coordinates);
  std::ranges::move(element_names(plugin.model.momenta), std::back_inserter(state));
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (parts && !observes(scene, state[i])) continue;
    columns.state.push_back(state[i]);
    columns.state_places.push_back(i);
  }
  columns.energy = observes(scene, "energy");
  columns.has_time = std::ranges::any_of(plugin.model.coordinates, &Variable::is_time);
  for (std::size_t i = 0; i < plugin.invariant_names.size(); ++i) {
    if (!observes(scene, plugin.invariant_names[i])) continue;
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
      fmt::format("h         {}, every {}", runtime::number_text(start.h.hi), every)};
  if (!scene.name.empty()) lines.push_back("scene     " + scene.name);
  for (const auto& [name, value] : parameter_values(plugin, scene, start))
    lines.push_back(fmt::format("parameter {} = {}", name, runtime::number_text(value)));
  return lines;
}

// Writes the emitted header if asked to; returns where it is, or how to see it.
std::string keep_header(const PluginSource& plugin, const Request& request,
                        const RunOptions& options) {
  if (options.header.empty()) return "print it with: " + request.command;
  const std::filesystem::path path = std::filesystem::path(options.header) / plugin.header.path;
  runtime::atomic_write(path, plugin.header.text);
  return path.string();
}

std::string trajectory_text(const std::string& output, const TrajectoryTable& table) {
  return fmt::format("{}, {} rows", output == "-" ? "on standard output" : output, table.rows());
}

int status_of(const RunReport& report) {
  const runtime::RunSummary& summary = report.summary;
  switch (summary.status) {
    case runtime::Status::done:
      if (interrupt_flag() && report.certificate) return interrupted;
      return report.certificate && !report.certificate->holds() ? numerical_failure : done;
    case runtime::Status::stopped:
      return interrupted;
    case runtime::Status::jumped:
    case runtime::Status::escaped:
    case runtime::Status::not_converged:
    case runtime::Status::left_domain:
    case runtime::Status::overflow:
    case runtime::Status::out_of_time:
    case runtime::Status::undefined:
      return numerical_failure;
  }
  internal_error("no such status");
}

void say(const RunReport& report, const RunOptions& options) {
  if (!options.quiet) print_error(summary_text(report));
  const std::string failure = failure_text(report);
  if (!failure.empty()) print_error("hamgen: " + failure + "\n");
  if (!failure.empty() && report.summary.status != runtime::Status::stopped)
    print_error(fmt::format("help: the state stays the last good one; try a smaller step, --h {}\n",
                            runtime::number_text(report.start->h.hi / 4.0)));
  if (options.json) print(json_text(report));
}

int run(const RunOptions& options) {
  if (options.json && options.output == "-")
    throw UsageError(
        "--json and -o - both write to standard output\nhelp: give the trajectory a file: -o "
        "FILE.csv");
  std::error_code missing;
  if (std::filesystem::equivalent(options.output, options.method.model, missing))
    throw UsageError(fmt::format("-o {}: that is the model; give the trajectory a file of its own",
                                 options.output));
  Setting setting = read_setting(options.method, options.scene);
  const SourceText& source = setting.source;
  const Model& model = setting.model;
  Request& request = setting.request;
  if (!model.warnings.empty() && !options.quiet) print_error(render(model.warnings, source));
  const SceneValues scene = complete_scene(model, setting.scene);
  const long every = record_distance(options, scene);
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
  report.header = keep_header(plugin, request, options);

  std::optional<TrajectoryTable> table;
  if (!options.output.empty())
    table.emplace(options.output, metadata(plugin, scene, start, every),
                  columns_of(plugin, scene, loaded.library->is_wide()));
  runtime::Integrator integrator(loaded.library, start);
  report.scalar_digits = loaded.library->plugin().scalar_digits;
  report.initial_invariants = integrator.invariants();
  runtime::ProgressBar bar(plugin.model.name);
  runtime::IntegrateOptions integrate_options;
  integrate_options.steps = *scene.steps;
  integrate_options.every = table ? every : 0;
  integrate_options.watch_energy = watches_energy(plugin, scene);
  integrate_options.end_at_jump = integrate_options.watch_energy;
  integrate_options.stop = &interrupt_flag();
  if (table) {
    integrate_options.on_record = [&](runtime::Record record) {
      const std::vector<runtime::Wide> state =
          whole_state(plugin, scene, {record.state.begin(), record.state.end()});
      record.state = state;
      table->add(record);
    };
  }
  if (!options.quiet)
    integrate_options.on_progress = [&bar](const auto& progress) { bar.update(progress); };
  report.summary = runtime::integrate(integrator, integrate_options);
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
  report.state = whole_state(plugin, scene, integrator.state());
  report.final_invariants = integrator.invariants();
  if (table) {
    table->publish(outcome_text(report));
    report.trajectory = trajectory_text(options.output, *table);
  }
  say(report, options);
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
      ->add_option("--every", options->every,
                   "step size, their number, rows every K steps; default: the scene's")
      ->type_name("K");
  parser->add_option("-o,--output", options->output, "the trajectory as CSV; - is standard output")
      ->type_name("FILE");
  parser->add_option("--watch-modified", options->watch_modified, "")->type_name("K");
  parser->add_flag("--certify", options->certify,
                   "K terms of the modified Hamiltonian; how near to the exact map");
  parser->add_flag("--json", options->json, "");
  parser->add_flag("--quiet", options->quiet, "the result as JSON; no summary, warnings, progress");
  parser->add_option("--header", options->header, "write the emitted header there")
      ->type_name("DIRECTORY");
  add_method_options(*parser, options->method);
  parser->add_option("--compiler", options->compiler, "")->type_name("PROGRAM");
  parser->add_flag("--interpret", options->interpret,
                   "default: $CXX, g++, clang++; or none, 20 to 100 times slower");
  parser->add_option("--flags", options->flags, "")->type_name("FLAGS");
  parser->add_flag("--portable", options->portable,
                   "more for the compiler; not for this machine's processor alone");
  return {parser, [options] { return run(*options); }};
}

}  // namespace hamgen::app
