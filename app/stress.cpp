// hamgen stress: the step far outside comfort, cell by cell.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>

#include "app/axis_option.hpp"
#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress_bars.hpp"
#include "app/output/stress_output.hpp"
#include "app/output/terminal.hpp"
#include "app/stress_axes.hpp"
#include "app/studies/initial_data.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::app {
namespace {

struct StressOptions {
  MethodOptions method;
  SceneOptions scene;
  std::vector<std::string> vary;
  std::string seconds = "1";
  std::string reference_seconds = "2";
  std::string output, csv, plot;
  bool json = false;
  bool quiet = false;
};

void write_stress_files(const StressOptions& options, const StressMap& map) {
  make_directories_above({options.output, options.csv, options.plot}, options.quiet);
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
  const OutputKind kind = output_kind(options.output);
  if (kind == OutputKind::csv) write(options.output, stress_csv(map));
  if (kind == OutputKind::json) write(options.output, stress_json(map));
  if (kind != OutputKind::directory) return;
  const fs::path directory = options.output;
  write(directory / "stress.csv", stress_csv(map));
  write(directory / "stress.json", stress_json(map));
  if (options.plot.empty()) draw(directory / "stress.svg");
}

// The length of a cell, 1000 steps where nothing is said.  A time is as many steps in all cells
// only where h is no axis.
SceneOptions with_length(SceneOptions scene, const std::vector<StressAxis>& axes) {
  if (scene.time) {
    if (std::ranges::any_of(axes, [](const auto& axis) { return axis.label == "h"; }))
      throw UsageError(fmt::format(
          "--time {}: h is an axis of the map, and so many steps are too long or too short for "
          "some cells\nhelp: say --steps N, or give two axes besides h: --vary A=1:2,B=1:2",
          *scene.time));
    return scene;
  }
  if (!scene.steps) scene.steps = "1000";
  static_cast<void>(integer_value("--steps " + *scene.steps, *scene.steps, 1));
  return scene;
}

StressLimits read_limits(const StressOptions& options, long steps) {
  StressLimits limits;
  limits.steps = steps;
  limits.time = std::chrono::duration<double>(
      static_cast<double>(integer_value("--seconds " + options.seconds, options.seconds, 1)));
  limits.reference_time = std::chrono::duration<double>(static_cast<double>(integer_value(
      "--reference-seconds " + options.reference_seconds, options.reference_seconds, 0)));
  limits.stop = &interrupt_flag();
  return limits;
}

int run_stress(const StressOptions& options) {
  if (!options.plot.empty() && !options.plot.ends_with(".svg") && !options.plot.ends_with(".png"))
    throw UsageError(fmt::format("--plot {}: the name ends in .svg or .png", options.plot));
  if (options.csv == "-")
    throw UsageError("--csv -: this names a file\nhelp: for the cells on standard output: -o -");
  if (options.csv.ends_with(".json"))
    throw UsageError(
        fmt::format("--csv {}: that is a name for JSON\nhelp: -o {}", options.csv, options.csv));
  StressRequest request;
  const OutputKind kind = output_kind(options.output);
  require_one_document(options.json, kind);
  require_writable({options.output, options.csv, options.plot});
  request.on_progress = progress_bars(options.quiet);
  request.with_bound = !options.plot.empty() || kind == OutputKind::directory;
  request.axes = read_axes(options.vary);
  const SceneOptions scene = with_length(options.scene, request.axes);
  request.setting = read_setting(with_run_time_members(options.method, request.axes), scene);
  std::vector<std::string> varied;
  for (const StressAxis& axis : request.axes) varied.push_back(axis.label);
  require_set_once(request.setting.scene, varied);
  require_not_folded(listed("--fold", options.method.fold), varied);
  const SceneValues values = complete_scene(request.setting.model, request.setting.scene);
  if (*values.steps == 0) throw UsageError(fmt::format("--time {}: less than a step", *scene.time));
  request.limits = read_limits(options, *values.steps);
  request.of_one_time = scene.time.has_value();
  specialise(scene, values, varied, Observing::everything, request.setting);
  const StressMap map = stress_map(request);
  if (interrupt_flag()) {
    print_error("hamgen: stopped; nothing was written\n");
    return interrupted;
  }
  print(options.json                   ? stress_json(map)
        : kind == OutputKind::standard ? stress_csv(map)
                                       : stress_text(map));
  write_stress_files(options, map);
  return done;
}

}  // namespace

Command add_stress(CLI::App& app) {
  const auto options = std::make_shared<StressOptions>();
  CLI::App* parser =
      app.add_subcommand("stress", "maps where a step stays bounded, cell by cell of a grid");
  add_scene_options(*parser, options->scene);
  add_step_option(*parser, options->scene);
  add_repeated(*parser, "--vary", options->vary,
               "two at most: parameter, h / scene h, scale, alpha, beta, gamma")
      ->type_name("NAME=LOW:HIGH:COUNT,...");
  parser->add_option("--time", options->scene.time, "")->type_name("T");
  parser
      ->add_option("--steps", options->scene.steps,
                   "of each cell, where h is no axis; their number; default 1000")
      ->type_name("N");
  parser->add_option("--seconds", options->seconds, "for each cell at most; default 1")
      ->type_name("N");
  parser
      ->add_option("--reference-seconds", options->reference_seconds,
                   "for all state errors; 0: none; default 2")
      ->type_name("N");
  parser
      ->add_option("-o,--output", options->output,
                   "stress.csv, .json, .gp and .svg there; or FILE.csv, FILE.json")
      ->type_name("DIRECTORY");
  parser->add_option("--csv", options->csv, "")->type_name("FILE");
  parser
      ->add_option("--plot", options->plot,
                   "the cells as CSV; a picture, .svg or .png, and its script .gp")
      ->type_name("FILE");
  parser->add_flag("--json", options->json, "");
  parser->add_flag("--quiet", options->quiet, "the cells as JSON; no progress, no names of files");
  add_method_options(*parser, options->method);
  return {parser, [options] { return run_stress(*options); }};
}

}  // namespace hamgen::app
