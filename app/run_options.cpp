#include "app/run_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/output/output_name.hpp"
#include "app/output/trajectory_plot.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {

void add_run_options(CLI::App& parser, RunOptions& options) {
  add_scene_options(parser, options.scene);
  add_observe_option(parser, options.scene);
  parser.add_option("--h", options.scene.h, "")->type_name("H");
  parser.add_option("--steps", options.scene.steps, "")->type_name("N");
  parser
      .add_option("--time", options.scene.time,
                  "size and number, or time, of steps; default: the scene's")
      ->type_name("T");
  parser.add_option("--every", options.every, "")->type_name("K");
  parser.add_option("--at", options.watch.at, "")->type_name("T");
  parser
      .add_option("--every-time", options.watch.every_time,
                  "rows every K steps, or at times: --at 1,2.5")
      ->type_name("T");
  add_repeated(parser, "--until", options.watch.until, "")->type_name("EXPR");
  parser
      .add_option("--seconds", options.watch.seconds,
                  "ends where it crosses zero, or as r < 1, energy_error > 1e-6")
      ->type_name("S");
  parser.add_option("-o,--output", options.output, "")->type_name("FILE");
  parser
      .add_option("--plot", options.plot,
                  "the trajectory: .csv, - is stdout; a picture: .svg, .png")
      ->type_name("FILE");
  parser.add_option("--columns", options.columns, "")->type_name("LIST");
  parser
      .add_option("--events", options.watch.events,
                  "drawn: q, q:p, x:y:z; what the events saw: .csv, .json")
      ->type_name("FILE");
  add_checkpoint_options(parser, options.checkpoint);
  add_checkpoint_interval(parser, options.checkpoint);
  parser.add_flag("--certify", options.certify, "default 60; how near it is to the exact map");
  parser.add_option("--watch-modified", options.watch_modified, "")->type_name("K");
  parser.add_flag("--interpret", options.interpret,
                  "terms of the modified Hamiltonian; without a compiler");
  parser.add_flag("--json", options.json, "");
  parser.add_flag("--quiet", options.quiet, "");
  parser.add_option("--header", options.header, "as JSON; no summary; the emitted header")
      ->type_name("DIR");
  add_method_options(parser, options.method);
  add_compiler_options(parser, options.compiler);
}

void require_run_files(const RunOptions& options) {
  if (options.json && options.output == "-")
    throw UsageError(
        "--json and -o - both write to standard output\nhelp: give the trajectory a file: -o "
        "FILE.csv");
  require_apart("-o", options.output, options.method.model, "the model");
  require_apart("--plot", options.plot, options.method.model, "the model");
  for (const auto& [option, file] : {std::pair("--checkpoint", &options.checkpoint.checkpoint),
                                     {"--resume", &options.checkpoint.resume}}) {
    require_apart(option, *file, options.method.model, "the model");
    require_apart(option, *file, options.output, "the trajectory of -o");
  }
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

}  // namespace hamgen::app
