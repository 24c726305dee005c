// hamgen tune: constant beta and gamma that flatten the energy of one orbit.
#include "app/studies/tune.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress_bars.hpp"
#include "app/output/terminal.hpp"
#include "app/output/tune_picture.hpp"
#include "app/output/tune_report.hpp"
#include "app/studies/initial_data.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

struct TuneOptions {
  MethodOptions method;  // of which there are the model and the scalar
  SceneOptions scene;
  std::string map, map_beta, map_gamma;
  CompilerChoice compiler;
  std::string form = "scalar";
  std::string samples = "1000";
  std::string grid;
  bool polish = false;
  bool json = false;
  bool quiet = false;
};

constexpr long kMostTuningSteps = 5'000;  // unless --time or --steps says otherwise

GaugeForm form_of(const std::string& text) {
  if (text == "scalar") return GaugeForm::scalar;
  if (text == "diagonal") return GaugeForm::diagonal;
  if (text == "matrix") return GaugeForm::matrix;
  throw UsageError(fmt::format("--gauge-form {}: there are scalar, diagonal and matrix", text));
}

// The scene's own time, if it has one, whatever --h is.
Rational own_time(const Setting& setting, const SceneValues& scene) {
  SceneRequest own = setting.scene;
  own.h.reset();
  return scene_values(setting.model, own).h.value_or(*scene.h) * *scene.steps;
}

// The run ends after a whole number of steps: h stays, the time gives way.
TuneRequest tune_request(const TuneOptions& options) {
  TuneRequest request;
  request.setting = read_setting(options.method, options.scene);
  request.polish = options.polish;
  request.compiler = options.compiler;
  const Model& model = request.setting.model;
  request.shape = {.form = form_of(options.form), .n = static_cast<int>(degrees_of_freedom(model))};
  if (request.shape.n == 0)
    throw UsageError(fmt::format("{} has no coordinates", options.method.model));
  request.scene = complete_scene(model, request.setting.scene, "--time 10");
  // The coefficients are parameters of the step: what they move does not rest.
  specialise(options.scene, request.scene, {}, Observing::everything, request.setting);
  const Rational h = *request.scene.h;
  const bool is_own = !options.scene.time && !options.scene.steps;
  request.time =
      is_own ? own_time(request.setting, request.scene) : Rational(h * *request.scene.steps);
  const double steps = to_double(Rational(request.time / h));
  if (!(steps > 0.0) || steps > 1e9)
    throw UsageError(
        fmt::format("a time of {:g} with h = {:g} makes {:g} steps\n"
                    "help: give another --time, --steps or --h",
                    to_double(request.time), to_double(h), steps));
  request.steps = std::max(1L, std::lround(steps));
  if (is_own) request.steps = std::min(request.steps, kMostTuningSteps);
  request.time = h * request.steps;
  request.setting.scene.h = hamgen::to_text(h);
  request.setting.scene.steps = std::to_string(request.steps);
  request.setting.scene.time.reset();
  request.samples = integer_value("--samples " + options.samples, options.samples, 3);
  request.stop = &interrupt_flag();
  request.on_progress = progress_bars(options.quiet);
  return request;
}

std::optional<MapRange> range_option(const std::string& option, const std::string& text) {
  if (text.empty()) return {};
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos)
    throw UsageError(fmt::format("{} {}: write LOW:HIGH", option, text));
  const MapRange range = {to_double(constant_option(option, text.substr(0, colon))),
                          to_double(constant_option(option, text.substr(colon + 1)))};
  if (!(range.low < range.high))
    throw UsageError(fmt::format("{} {}: LOW is below HIGH", option, text));
  return range;
}

MapRequest map_request_of(const TuneOptions& options) {
  if (options.map.empty()) {
    for (const auto& [name, value] :
         {std::pair{"--grid", &options.grid}, std::pair{"--map-beta", &options.map_beta},
          std::pair{"--map-gamma", &options.map_gamma}}) {
      if (!value->empty())
        throw UsageError(fmt::format("{} {}: of which map?\nhelp: add --map FILE", name, *value));
    }
    return {};
  }
  const std::string ending = std::filesystem::path(options.map).extension().string();
  if (!ending.empty() && ending != ".png" && ending != ".svg")
    throw UsageError(fmt::format("--map {}: the name ends in .svg or .png", options.map));
  const std::string grid = options.grid.empty() ? "41" : options.grid;
  const long cells = integer_value("--grid " + grid, grid, 2);
  if (cells > 1000) throw UsageError(fmt::format("--grid {}: at most 1000 cells a side", grid));
  return {.cells = static_cast<int>(cells),
          .beta = range_option("--map-beta", options.map_beta),
          .gamma = range_option("--map-gamma", options.map_gamma)};
}

// FILE.csv, FILE.gp and, if gnuplot is there, FILE.png (or .svg).
void write_map(const TuneOptions& options, const EnergyMap& map, const TuneReport& report) {
  make_directories_above({options.map}, options.quiet);
  namespace fs = std::filesystem;
  fs::path picture = options.map;
  if (picture.extension() != ".svg") picture.replace_extension(".png");
  fs::path csv = options.map;
  csv.replace_extension(".csv");
  fs::path script = options.map;
  script.replace_extension(".gp");
  const std::string title = fmt::format("{}{}: energy spread, h = {}, {} steps", report.model,
                                        report.scene.empty() ? "" : ", scene " + report.scene,
                                        runtime::number_text(report.h), report.steps);
  const std::string header = fmt::format("# made by   hamgen " HAMGEN_VERSION
                                         "\n# {}\n# beta = b*h, gamma = c*h; energy_spread is max "
                                         "H - min H, empty where the run failed\n",
                                         comment_text(title));
  runtime::atomic_write(csv, map_csv(map, header));
  if (std::ranges::none_of(map.spread, is_drawn)) {
    print_error("hamgen: no picture: nowhere on the map is there an energy error to draw\n");
    if (!options.quiet) print_error(fmt::format("{}\n", csv.string()));
    return;
  }
  if (!options.quiet) print_error(fmt::format("{}\n", csv.string()));
  if (!draw_picture({.picture = picture,
                     .script = script,
                     .text = map_script(map, report.energy_scale(), title, picture.string())},
                    options.quiet, &interrupt_flag())) {
    std::error_code ignored;
    fs::remove(picture, ignored);  // what gnuplot began
  }
}

int run_tune(const TuneOptions& options) {
  const MapRequest map_request = map_request_of(options);
  const TuneRequest request = tune_request(options);
  if (!options.map.empty() && request.shape.form != GaugeForm::scalar && request.shape.n > 1)
    throw UsageError("--map draws one beta and one gamma: --gauge-form scalar");
  require_writable({options.map});
  Tuner tuner(request);
  const TuneReport report = tuner.run();
  if (interrupt_flag()) {
    print_error("hamgen: stopped; no gauge was found\n");
    return interrupted;
  }
  if (!report.orbit_failure.empty())
    print_error(
        fmt::format("hamgen: the orbit cannot be followed: {}\nhelp: try a shorter --time\n",
                    report.orbit_failure));
  if (!report.orbit_failure.empty()) return numerical_failure;
  print(options.json ? tune_json(report) : tune_text(report));
  if (!options.map.empty()) {
    const EnergyMap map = tuner.map(map_request);
    if (interrupt_flag()) {
      print_error("hamgen: stopped; no map was written\n");
      return interrupted;
    }
    write_map(options, map, report);
  }
  return report.gauges.back().measured.failure.empty() ? done : numerical_failure;
}

}  // namespace

Command add_tune(CLI::App& app) {
  const auto options = std::make_shared<TuneOptions>();
  CLI::App* parser =
      app.add_subcommand("tune", "finds constant beta, gamma that flatten the energy of one orbit");
  parser->add_option("MODEL", options->method.model, "a .ham file")->required();
  add_scene_options(*parser, options->scene);
  add_step_option(*parser, options->scene);
  parser->add_option("--time", options->scene.time, "")->type_name("T");
  parser->add_option("--steps", options->scene.steps, "default: the scene's, at most 5000 steps")
      ->type_name("N");
  parser->add_option("--gauge-form", options->form, "scalar (default), diagonal or matrix")
      ->type_name("FORM");
  parser->add_option("--samples", options->samples, "points of the orbit to fit; default 1000")
      ->type_name("N");
  parser->add_flag("--polish", options->polish, "then minimise the measured energy spread");
  parser->add_option("--scalar", options->method.scalar, "of the runs; default double")
      ->type_name("TYPE");
  parser
      ->add_option("--map", options->map, "energy spread over the beta, gamma plane: CSV, picture")
      ->type_name("FILE");
  parser->add_option("--grid", options->grid, "cells a side of the map; default 41")
      ->type_name("N");
  parser->add_option("--map-beta", options->map_beta, "its range of b, beta = b*h")
      ->type_name("LOW:HIGH");
  parser->add_option("--map-gamma", options->map_gamma, "its range of c, gamma = c*h")
      ->type_name("LOW:HIGH");
  parser->add_flag("--json", options->json, "the result as JSON on standard output");
  parser->add_flag("--quiet", options->quiet, "no progress, no names of files");
  add_compiler_options(*parser, options->compiler);
  return {parser, [options] { return run_tune(*options); }};
}

}  // namespace hamgen::app
