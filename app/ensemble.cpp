// hamgen ensemble: many trajectories, and what is asked about each of them.
#include "app/studies/ensemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>

#include "app/axis_option.hpp"
#include "app/ensemble_options.hpp"
#include "app/interrupt.hpp"
#include "app/output/ensemble_file.hpp"
#include "app/output/ensemble_output.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress_bars.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/crew.hpp"
#include "app/studies/ensemble_parts.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "app/studies/manifest.hpp"
#include "app/studies/threads.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

// The integrator, and what is varied.
struct Prepared {
  Setting setting;
  PluginSource plugin;
  runtime::LoadedPlugin loaded;
  EnsembleRequest request;
};

void prepare(const EnsembleOptions& options, Prepared& prepared) {
  Setting& setting = prepared.setting;
  EnsembleRequest& request = prepared.request;
  setting = read_setting(options.method, options.scene);
  request.plan = read_plan(options, setting.model);
  require_set_once(setting.scene, request.plan.names());
  require_apart("-o", options.output, options.method.model, "the model");
  require_apart("-o", options.output, request.plan.table.path, "the table of --from");
  if (!options.every.empty() && options.statistics.empty())
    throw UsageError(fmt::format(
        "--every {}: statistics are taken over these states, and none are asked for\nhelp: for "
        "example --statistics energy",
        options.every));
  const ObservedAndStatistics observed =
      read_statistics(options.statistics, setting.model, setting.scene);
  if (!observed.observe.empty()) setting.scene.observe = observed.observe;
  request.statistics = observed.statistics;
  request.scene = setting.scene;
  request.values = complete_scene(setting.model, setting.scene);
  if (!options.every.empty())
    request.every = integer_value("--every " + options.every, options.every, 1);
  take_gauge_at(request.values, setting.model, setting.request);
  specialise(options.scene, request.values, request.plan.names(), Observing::as_the_scene, setting);
  prepared.plugin = generate_plugin(setting.source, setting.request);
  request.plugin = &prepared.plugin;
  const double steps =
      steps_of_all(setting.model, setting.scene, request.values, request.plan.names(),
                   static_cast<double>(request.plan.count()));
  prepared.loaded = load_integrator(prepared.plugin, options.compiler, &interrupt_flag(), steps);
  request.library = prepared.loaded.library;
  request.stop = &interrupt_flag();
}

EnsembleManifest manifest_of(const EnsembleOptions& options, const Prepared& prepared,
                             const Ensemble& ensemble) {
  EnsembleManifest manifest{.lines = manifest_lines(prepared.setting, prepared.request.values,
                                                    prepared.plugin, options.compiler),
                            .columns = ensemble.columns(),
                            .count = ensemble.count(),
                            .block = block_size(*prepared.request.values.steps, ensemble.count())};
  std::vector<std::string>& lines = manifest.lines;
  std::ranges::move(prepared.request.plan.to_text(), std::back_inserter(lines));
  if (!prepared.request.statistics.empty())
    lines.push_back(fmt::format("statistics over every {} of: {}", prepared.request.every,
                                fmt::join(prepared.request.statistics, ", ")));
  return manifest;
}

// The output is there, whole, and nothing else: an earlier command came to its end.
bool is_complete(const EnsembleOptions& options, const EnsembleManifest& manifest) {
  if (!options.resume || !std::filesystem::exists(options.output) ||
      std::filesystem::exists(parts_directory(options.output)))
    return false;
  std::vector<std::string> lines = manifest_lines_of(options.output);
  const std::string difference = difference_of(lines, manifest.lines);
  if (difference.empty() && is_whole(options.output)) return true;
  if (difference.empty())
    throw UsageError(
        fmt::format("--resume: {} is cut off, and its parts are gone\nhelp: another name of the "
                    "output, or leave out --resume to write it anew",
                    options.output));
  throw UsageError(
      fmt::format("--resume: {} is of another ensemble:\n{}help: another name of the output, or "
                  "leave out --resume to write it anew",
                  options.output, difference));
}

// The blocks that are missing, by all threads of all processes; false if it was stopped.
bool work_off(const EnsembleOptions& options, Crew& crew, const Ensemble& ensemble,
              const EnsembleManifest& manifest, const std::vector<long long>& missing) {
  runtime::PartFile part(part_path(options.output, crew.rank()));
  std::mutex guard;
  const auto work = [&](long long k) {
    const long long number = missing[static_cast<std::size_t>(k)];
    const std::vector<EnsembleRow> rows =
        ensemble.block(number * manifest.block, manifest.rows_of(number));
    if (rows.empty()) return false;
    const std::vector<std::byte> bytes = packed(rows);
    const std::scoped_lock lock(guard);
    part.append(static_cast<std::uint64_t>(number), bytes);
    return true;
  };
  Work progress(progress_bars(options.quiet || !crew.leads()), "ensemble",
                static_cast<long long>(missing.size()));
  const bool is_done = crew.hand_out(static_cast<long long>(missing.size()), read_threads(options),
                                     work, [&progress](long long done) { progress.tell(done); });
  part.sync();
  crew.wait_for_all();
  return is_done;
}

int finish(const EnsembleOptions& options, EnsembleParts& parts, const Ensemble& ensemble,
           const EnsembleManifest& manifest, const EnsembleTitle& title, bool is_done) {
  EnsembleSummary summary;
  parts.scan();
  if (const std::vector<long long> missing = parts.missing(); !missing.empty()) {
    if (is_done) internal_error("blocks are missing");
    print_error(fmt::format(
        "hamgen: stopped: {} of {} trajectories are done, and kept in {}\nhelp: --resume goes on\n",
        std::max(0LL, manifest.count - manifest.block * static_cast<long long>(missing.size())),
        manifest.count, parts_directory(options.output).string()));
    return interrupted;
  }
  const auto file =
      make_ensemble_file(options.output, {.manifest = &manifest, .varied = ensemble.varied()});
  parts.read([&](const std::vector<EnsembleRow>& rows) {
    add(summary, rows, ensemble.energy_error());
    file->add(rows);
  });
  file->publish("ended     " + endings_text(summary));
  parts.remove();
  if (!options.quiet) print_error(ensemble_text(summary, title));
  if (options.json) print(ensemble_json(summary, title));
  return summary.ended[static_cast<std::size_t>(runtime::Status::done)] > 0 ? done
                                                                            : numerical_failure;
}

int run_ensemble(const EnsembleOptions& options, Crew& crew) {
  if (options.output.empty())
    throw UsageError("the results want a file\nhelp: for example -o ensemble.csv");
  static_cast<void>(ensemble_format(options.output));
  static_cast<void>(read_threads(options));
  Prepared prepared;
  // Where several compile the same, one does it for all, and says what is wrong with it.
  crew.leader_first([&] { prepare(options, prepared); });
  const Ensemble ensemble(prepared.request);
  const EnsembleManifest manifest = manifest_of(options, prepared, ensemble);
  if (is_complete(options, manifest)) {
    if (crew.leads() && !options.quiet) print_error(options.output + ": nothing is missing\n");
    return done;
  }
  EnsembleTitle title{.model = prepared.setting.model.name,
                      .scene = prepared.request.values.name,
                      .scheme = prepared.plugin.scheme_name,
                      .h = to_double(*prepared.request.values.h),
                      .steps = *prepared.request.values.steps,
                      .varied = prepared.request.plan.names(),
                      .columns = manifest.columns,
                      .output = options.output,
                      .watches_energy = ensemble.watches_energy()};
  std::unique_ptr<EnsembleParts> parts;
  std::vector<long long> missing;
  bool has_all = false;
  if (crew.leads()) has_all = is_complete(options, manifest);
  if (crew.leads() && !has_all) {
    make_directories_above({options.output}, options.quiet);
    parts = std::make_unique<EnsembleParts>(options.output, manifest, options.resume);
    parts->scan();
    missing = parts->missing();
    title.spoilt = parts->spoilt();
    for (const long long number : missing) title.done_before -= manifest.rows_of(number);
    title.done_before += manifest.count;
    if (!has_threads() && !options.quiet)
      print_error("hamgen: one thread: built without oneTBB; the package libtbb-dev brings more\n");
  }
  missing = crew.share(std::move(missing));
  if (crew.share({has_all ? 1 : 0}).front() == 1) {
    crew.wait_for_all();
    if (crew.leads() && !options.quiet) print_error(options.output + ": nothing is missing\n");
    return done;
  }
  const bool is_done = work_off(options, crew, ensemble, manifest, missing);
  return crew.leads() ? finish(options, *parts, ensemble, manifest, title, is_done) : done;
}

}  // namespace

Command add_ensemble(CLI::App& app, Crew& crew) {
  const auto options = std::make_shared<EnsembleOptions>();
  CLI::App* parser = app.add_subcommand(
      "ensemble", "many trajectories on all processors, and what is asked about each of them");
  add_ensemble_options(*parser, *options);
  return {parser, [options, &crew] { return run_ensemble(*options, crew); }};
}

}  // namespace hamgen::app
