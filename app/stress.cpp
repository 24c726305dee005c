// hamgen stress: the step far outside comfort, cell by cell.
#include "app/studies/stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "app/interrupt.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/stress_domain.hpp"
#include "app/studies/stress_grid.hpp"
#include "app/studies/stress_references.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/compile.hpp"
#include "runtime/compiler.hpp"
#include "runtime/progress.hpp"

namespace hamgen::app {
namespace {

constexpr unsigned kThreads = 2;

StressMap empty_map(const StressGrid& grid, const StressLimits& limits) {
  StressMap map{
      .model = grid.plugin().model.name,
      .scene = grid.scene_name(),
      .method = grid.plugin().scheme_name,
      .axes = grid.axes(),
      .steps = limits.steps,
      .compiler = fmt::format("{} {}", runtime::compiler_version(runtime::find_compiler()),
                              fmt::join(runtime::compile_flags({}, {}), " "))};
  map.cells.resize(map.columns() * map.rows());
  return map;
}

// work(0), work(1), ... on two threads; the calling one draws the bar.
void run_all(const std::string& label, std::size_t count, bool quiet,
             const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> finished = 0;
  static_cast<void>(interrupt_flag());  // its handler is installed before there are threads
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < kThreads; ++i) {
    threads.emplace_back([&] {
      for (std::size_t k = next++; k < count && !interrupt_flag(); k = next++) {
        work(k);
        ++finished;
      }
    });
  }
  runtime::ProgressBar bar(label);
  const auto begin = std::chrono::steady_clock::now();
  while (finished < count && !interrupt_flag()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (quiet) continue;
    bar.update(
        {.steps_done = static_cast<long long>(finished.load()),
         .steps = static_cast<long long>(count),
         .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
         .show_rate = false});
  }
  bar.remove();
}

void run_cells(StressGrid& grid, const StressLimits& limits, StressMap& map, bool quiet) {
  std::vector<runtime::InitialValues> starts(map.cells.size());
  std::size_t undefined = 0;
  // In a map of nothing but these the model or the command is wrong: the caller's exception.
  const auto is_undefined = [&](StressCell& cell, const std::string& reason) {
    if (++undefined == map.cells.size()) return false;
    cell.outcome = StressOutcome::undefined;
    cell.bounded = false;
    cell.reason = reason;
    cell.state_missing = to_text(cell.outcome);
    return true;
  };
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    StressCell& cell = map.cells[i];
    const std::vector<double> at = map.place(i);
    std::ranges::copy(at, cell.at.begin());
    try {
      starts[i] = grid.start_at(at);
    } catch (const ModelError& error) {
      if (!is_undefined(cell, error.diagnostics().front().message)) throw;
      continue;
    } catch (const UsageError& error) {  // a pole of the gauge, a value beyond the scalar's range
      const std::string text = error.what();
      if (!is_undefined(cell, text.substr(0, text.find('\n')))) throw;
      continue;
    }
    cell.h = starts[i].h.hi;
    if (const auto linear = grid.linear_at(at)) {
      cell.h_omega = linear->h_omega;
      cell.linear_bounded = linear->margin > 0.0;
    }
  }
  StressReferences references(grid, map, limits);
  run_all(map.model + ", references", references.count(), quiet,
          [&](std::size_t i) { references.compute(i); });
  map.references = references.method();
  run_all(map.model, map.cells.size(), quiet, [&](std::size_t i) {
    StressCell& cell = map.cells[i];
    if (cell.outcome == StressOutcome::undefined) return;
    const auto state = run_stress_cell(grid.library(), starts[i], limits, cell);
    references.compare(i, starts[i].state, state, cell);
  });
}

void write_stress_files(const StressOptions& options, const StressMap& map) {
  namespace fs = std::filesystem;
  const auto write = [&options](const fs::path& path, const std::string& text) {
    runtime::atomic_write(path, text);
    if (!options.quiet) print_error(fmt::format("{}\n", path.string()));
  };
  const auto draw = [&](const fs::path& picture) {
    draw_picture({.picture = picture,
                  .script = fs::path(picture).replace_extension(".gp"),
                  .text = stress_script(map, picture.string())},
                 options.quiet, &interrupt_flag());
  };
  if (!options.csv.empty()) write(options.csv, stress_csv(map));
  if (!options.plot.empty()) draw(options.plot);
  if (options.output.empty()) return;
  const fs::path directory = options.output;
  write(directory / "stress.csv", stress_csv(map));
  write(directory / "stress.json", stress_json(map));
  if (options.plot.empty()) draw(directory / "stress.svg");
}

int run_stress(const StressOptions& options) {
  if (!options.plot.empty() && !options.plot.ends_with(".svg") && !options.plot.ends_with(".png"))
    throw UsageError(fmt::format("--plot {}: the name ends in .svg or .png", options.plot));
  StressLimits limits;
  limits.steps = integer_value("--steps " + options.steps, options.steps, 1);
  limits.time = std::chrono::duration<double>(
      static_cast<double>(integer_value("--seconds " + options.seconds, options.seconds, 1)));
  limits.reference_time = std::chrono::duration<double>(static_cast<double>(integer_value(
      "--reference-seconds " + options.reference_seconds, options.reference_seconds, 0)));
  StressGrid grid(options);
  limits.defined_everywhere = is_defined_everywhere(grid.plugin().model);
  StressMap map = empty_map(grid, limits);
  run_cells(grid, limits, map, options.quiet);
  if (interrupt_flag()) {
    print_error("hamgen: stopped; nothing was written\n");
    return interrupted;
  }
  map.linear_bound = grid.linear_bound();
  print(options.json ? stress_json(map) : stress_text(map));
  write_stress_files(options, map);
  return done;
}

}  // namespace

Command add_stress(CLI::App& app) {
  const auto options = std::make_shared<StressOptions>();
  CLI::App* parser =
      app.add_subcommand("stress", "maps where a step stays bounded, cell by cell of a grid");
  add_scene_options(*parser, options->scene);
  add_step_option(*parser, options->h);
  add_repeated(*parser, "--vary", options->vary,
               "an axis: a parameter, h, scale, alpha, beta, gamma; twice at most")
      ->type_name("NAME=LOW:HIGH[:COUNT]");
  parser->add_option("--steps", options->steps, "of each cell; default 1000")->type_name("N");
  parser->add_option("--seconds", options->seconds, "for each cell at most; default 1")
      ->type_name("N");
  parser
      ->add_option("--reference-seconds", options->reference_seconds,
                   "for all state errors; 0: none; default 10")
      ->type_name("N");
  parser->add_option("-o,--output", options->output, "write stress.csv, .json, .gp and .svg there")
      ->type_name("DIRECTORY");
  parser->add_option("--csv", options->csv, "")->type_name("FILE");
  parser
      ->add_option("--plot", options->plot,
                   "the cells as CSV; a picture, .svg or .png, and its script .gp")
      ->type_name("FILE");
  parser->add_flag("--json", options->json, "the cells as JSON on standard output");
  parser->add_flag("--quiet", options->quiet, "no progress, no names of files");
  add_method_options(*parser, options->method);
  return {parser, [options] { return run_stress(*options); }};
}

}  // namespace hamgen::app
