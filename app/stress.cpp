// hamgen stress: the step far outside comfort, cell by cell.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/draw_picture.hpp"
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
  std::string reference_seconds = "10";
  std::string output, csv, plot;
  bool json = false;
  bool quiet = false;
};

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

StressLimits read_limits(const StressOptions& options) {
  StressLimits limits;
  limits.steps = integer_value("--steps " + *options.scene.steps, *options.scene.steps, 1);
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
  StressRequest request;
  request.limits = read_limits(options);
  request.on_progress = progress_bars(options.quiet);
  request.axes = read_axes(options.vary);
  request.setting =
      read_setting(with_run_time_members(options.method, request.axes), options.scene);
  std::vector<std::string> varied;
  for (const StressAxis& axis : request.axes) varied.push_back(axis.label);
  specialise(options.scene, complete_scene(request.setting.model, request.setting.scene), varied,
             Observing::everything, request.setting);
  const StressMap map = stress_map(request);
  if (interrupt_flag()) {
    print_error("hamgen: stopped; nothing was written\n");
    return interrupted;
  }
  print(options.json ? stress_json(map) : stress_text(map));
  write_stress_files(options, map);
  return done;
}

}  // namespace

Command add_stress(CLI::App& app) {
  const auto options = std::make_shared<StressOptions>();
  options->scene.steps = "1000";
  CLI::App* parser =
      app.add_subcommand("stress", "maps where a step stays bounded, cell by cell of a grid");
  add_scene_options(*parser, options->scene);
  add_step_option(*parser, options->scene);
  add_repeated(*parser, "--vary", options->vary,
               "an axis: a parameter, h, scale, alpha, beta, gamma; twice at most")
      ->type_name("NAME=LOW:HIGH[:COUNT]");
  parser->add_option("--steps", options->scene.steps, "of each cell; default 1000")->type_name("N");
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
  parser->add_flag("--json", options->json, "");
  parser->add_flag("--quiet", options->quiet, "the cells as JSON; no progress, no names of files");
  add_method_options(*parser, options->method);
  return {parser, [options] { return run_stress(*options); }};
}

}  // namespace hamgen::app
