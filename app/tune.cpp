// hamgen tune: constant beta and gamma that flatten the energy of one orbit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/terminal.hpp"
#include "app/output/tune_report.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/reference.hpp"
#include "app/studies/tune_map.hpp"
#include "app/studies/tune_polish.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/csv_writer.hpp"
#include "runtime/progress.hpp"

namespace hamgen::app {
namespace {

struct TuneOptions {
  std::string model;
  SceneOptions scene;
  std::string h, time, compiler, scalar, map, map_beta, map_gamma;
  std::string form = "scalar";
  std::string samples = "1000";
  std::string grid;
  bool polish = false;
  bool json = false;
  bool quiet = false;
};

constexpr long kMostTuningSteps = 5'000;  // unless --time says otherwise

struct TuneSetting {
  SourceText source;
  Request base;
  SceneRequest request;
  SceneValues scene;
  GaugeShape shape;
  Rational time;
  long steps = 0;
};

Rational constant_option(const std::string& option, const std::string& text) {
  const std::string what = option + " " + text;
  return evaluate_constant(read_expression(what, text, {}), make_source(what, text), {});
}

GaugeForm form_of(const std::string& text) {
  if (text == "scalar") return GaugeForm::scalar;
  if (text == "diagonal") return GaugeForm::diagonal;
  if (text == "matrix") return GaugeForm::matrix;
  throw UsageError(fmt::format("--gauge-form {}: there are scalar, diagonal and matrix", text));
}

// The run ends after a whole number of steps: h stays, the time gives way.
TuneSetting tune_setting(const TuneOptions& options) {
  TuneSetting setting;
  setting.source = read_model_source({.model = options.model});
  SizesAndRest set = split_sizes(read_model(setting.source), options.scene.set);
  setting.base.sizes = set.sizes;
  setting.base.scalar = options.scalar;
  setting.request = scene_request(options.scene, std::move(set.rest));
  const Model model = read_model(setting.source, set.sizes);
  setting.shape = {.form = form_of(options.form), .n = static_cast<int>(degrees_of_freedom(model))};
  if (setting.shape.n == 0) throw UsageError(fmt::format("{} has no coordinates", options.model));
  if (!options.time.empty()) setting.request.steps = "1";
  if (options.h.empty()) {
    setting.scene = complete_scene(model, setting.request, "--time 10");
    setting.time = *setting.scene.h * *setting.scene.steps;
  } else {
    // The scene's own time, if it has one, whatever h is.
    const SceneValues own = scene_values(model, setting.request);
    setting.request.h = options.h;
    setting.scene = complete_scene(model, setting.request, "--time 10");
    setting.time = own.h.value_or(*setting.scene.h) * *setting.scene.steps;
  }
  const Rational h = *setting.scene.h;
  if (!options.time.empty()) setting.time = constant_option("--time", options.time);
  const double steps = to_double(Rational(setting.time / h));
  if (!(steps > 0.0) || steps > 1e9)
    throw UsageError(
        fmt::format("a time of {:g} with h = {:g} makes {:g} steps\n"
                    "help: give another --time or --h",
                    to_double(setting.time), to_double(h), steps));
  setting.steps = std::max(1L, std::lround(steps));
  if (options.time.empty()) setting.steps = std::min(setting.steps, kMostTuningSteps);
  setting.time = h * setting.steps;
  setting.request.h = hamgen::to_text(h);
  setting.request.steps = std::to_string(setting.steps);
  return setting;
}

// A bar for work whose fraction is known.
std::function<void(double)> bar_of(runtime::ProgressBar& bar, bool quiet) {
  if (quiet) return {};
  return [&bar, begin = std::chrono::steady_clock::now()](double part) {
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    bar.update({.steps_done = static_cast<long long>(1000 * part),
                .steps = 1000,
                .seconds = seconds,
                .show_rate = false});
  };
}

struct MapRange {
  double low = 0.0;
  double high = 0.0;
};

struct MapOptions {
  int cells = 0;  // a side
  std::optional<MapRange> beta, gamma;
};

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

MapOptions map_options_of(const TuneOptions& options) {
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

class Tuner {
 public:
  Tuner(const TuneOptions& options, const TuneSetting& setting)
      : options_(options),
        setting_(setting),
        h_(to_double(*setting.scene.h)),
        integrator_(setting.source, setting.base, setting.shape, setting.request,
                    options.compiler) {}

  // Empty, with the reason said, if the orbit could not be followed.
  std::optional<TuneReport> run() {
    report_ = {.path = options_.model,
               .scene = setting_.scene.name,
               .h = h_,
               .time = to_double(setting_.time),
               .steps = setting_.steps,
               .shape = setting_.shape};
    report_.model = read_model(setting_.source).name;
    if (!follow_orbit()) return std::nullopt;
    reference();
    const runtime::Flattening flat = fit_gauge(orbit_, setting_.shape);
    report_.rank = flat.rank;
    add("implicit midpoint", std::vector<double>(setting_.shape.size(), 0.0));
    add("tuned", flat.coefficients);
    if (options_.polish) polish_all();
    Request request = setting_.base;
    const GaugeTexts texts =
        gauge_texts(setting_.shape, number_texts(report_.gauges.back().coefficients));
    request.beta = texts.beta;
    request.gamma = texts.gamma;
    report_.command = generate_command(options_.model, request);
    return report_;
  }

  // The plane around the analytic pair: from 0 to twice its values, or as far as was asked.
  [[nodiscard]] EnergyMap map(const MapOptions& wanted) const {
    const std::vector<double>& pair = report_.gauges[1].coefficients;
    const MapAxis b = axis(wanted.beta, wanted.cells, pair[0], std::fabs(orbit_.initial_energy));
    const MapAxis c = axis(wanted.gamma, wanted.cells, pair[1], 1.0);
    runtime::ProgressBar bar("map");
    const auto progress = bar_of(bar, options_.quiet);
    const double cells = static_cast<double>(b.count) * c.count;
    EnergyMap map = energy_map(integrator_, b, c, h_, setting_.steps, [&](std::size_t done) {
      if (progress) progress(static_cast<double>(done) / cells);
    });
    map.fitted = {pair[0], pair[1]};
    // With beta = -h or gamma = h the bound is h < r, so -b h^2 and c h^2 are to be below r^2.
    const StabilityBound of_b = stability_bound(orbit_, setting_.shape, {-1.0, 0.0});
    const StabilityBound of_c = stability_bound(orbit_, setting_.shape, {0.0, 1.0});
    if (of_b.known && of_b.below) map.lowest_b = -std::pow(*of_b.below / h_, 2);
    if (of_c.known && of_c.below) map.highest_c = std::pow(*of_c.below / h_, 2);
    return map;
  }

 private:
  bool follow_orbit() {
    runtime::ProgressBar bar("orbit");
    OrbitRequest request{.method = setting_.base, .time = setting_.time};
    request.samples = integer_value("--samples " + options_.samples, options_.samples, 3);
    request.compiler = options_.compiler;
    request.on_progress = bar_of(bar, options_.quiet);
    orbit_ = sample_orbit(setting_.source, setting_.scene, request);
    report_.samples = orbit_.points.size();
    report_.initial_energy = orbit_.initial_energy;
    bar.remove();
    if (orbit_.failure.empty()) return true;
    print_error(fmt::format(
        "hamgen: the orbit cannot be followed: {}\nhelp: try a shorter --time\n", orbit_.failure));
    return false;
  }

  void reference() {
    runtime::ProgressBar bar("reference");
    ReferenceRequest request{.sizes = setting_.base.sizes, .compiler = options_.compiler};
    request.on_progress = bar_of(bar, options_.quiet);
    reference_ = reference_solution(setting_.source, setting_.scene, setting_.time, request);
    report_.reference_failure = reference_.failure;
  }

  void add(const std::string& name, const std::vector<double>& coefficients) {
    TunedGauge gauge{.name = name, .coefficients = coefficients};
    gauge.predicted_spread = h_ * h_ * bracket_spread(orbit_, setting_.shape, coefficients);
    gauge.measured = integrator_.measure(coefficients, h_, setting_.steps);
    if (gauge.measured.failure.empty() && !reference_.state.empty())
      gauge.state_error = distance(gauge.measured.state, reference_.state);
    gauge.stability = stability_bound(orbit_, setting_.shape, coefficients);
    report_.gauges.push_back(std::move(gauge));
  }

  // From the narrowest form on, each from the better of its own fit and of the form before: a wider
  // form never ends worse than one that it contains.
  void polish_all() {
    std::vector<double> best = report_.gauges.back().coefficients;
    const auto spread = [this](const std::vector<double>& coefficients) {
      const Measurement measured = integrator_.measure(coefficients, h_, setting_.steps);
      return measured.failure.empty() ? measured.energy_spread : HUGE_VAL;
    };
    std::optional<GaugeShape> before;
    for (const GaugeForm form : {GaugeForm::scalar, GaugeForm::diagonal, GaugeForm::matrix}) {
      if (form > setting_.shape.form) break;
      const GaugeShape shape = {.form = form, .n = setting_.shape.n};
      if (before && shape.size() == before->size()) continue;
      const auto value = [&](const std::vector<double>& coefficients) {
        return spread(widened(shape, coefficients, setting_.shape));
      };
      std::vector<double> start = fit_gauge(orbit_, shape).coefficients;
      if (before) {
        std::vector<double> narrow = widened(*before, best, shape);
        if (!(value(start) < value(narrow))) start = std::move(narrow);
      }
      const Polished polished = polish_from(value, start);
      best = polished.coefficients;
      report_.evaluations += polished.evaluations;
      report_.polish_ended = polished.ended;
      before = shape;
    }
    add("polished", widened(*before, best, setting_.shape));
  }

  static Polished polish_from(const std::function<double(const std::vector<double>&)>& value,
                              const std::vector<double>& start) {
    constexpr int most_runs = 400;  // a coefficient
    // The next term of the energy is O(h^2) smaller: the best coefficients are near.
    double largest = 0.0;
    for (const double x : start) largest = std::max(largest, std::fabs(x));
    if (largest == 0.0) return {.coefficients = start, .ended = true};
    std::vector<double> steps = start;
    for (double& x : steps) x = 1e-3 * (x != 0.0 ? std::fabs(x) : largest);
    return polish(value, start, steps, most_runs * static_cast<int>(start.size()));
  }

  [[nodiscard]] static MapAxis axis(const std::optional<MapRange>& range, int cells, double tuned,
                                    double scale) {
    if (range) return {.low = range->low, .high = range->high, .count = cells};
    const double end = tuned != 0.0 ? 2 * tuned : scale / 6;
    return {.low = std::min(0.0, end), .high = std::max(0.0, end), .count = cells};
  }

  const TuneOptions& options_;
  const TuneSetting& setting_;
  double h_;
  GaugedIntegrator integrator_;
  Orbit orbit_;
  ReferenceSolution reference_;
  TuneReport report_;
};

// FILE.csv, FILE.gp and, if gnuplot is there, FILE.png (or .svg).
void write_map(const TuneOptions& options, const EnergyMap& map, const TuneReport& report) {
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
                                         title);
  runtime::atomic_write(csv, map_csv(map, header));
  if (std::ranges::none_of(map.spread, is_drawn)) {
    print_error("hamgen: no picture: nowhere on the map is there an energy error to draw\n");
    if (!options.quiet) print_error(fmt::format("{}\n", csv.string()));
    return;
  }
  if (!options.quiet) print_error(fmt::format("{}\n", csv.string()));
  if (!draw_picture(
          {.picture = picture, .script = script, .text = map_script(map, title, picture.string())},
          options.quiet, &interrupt_flag())) {
    std::error_code ignored;
    fs::remove(picture, ignored);  // what gnuplot began
  }
}

int run_tune(const TuneOptions& options) {
  const MapOptions map_options = map_options_of(options);
  const TuneSetting setting = tune_setting(options);
  if (!options.map.empty() && setting.shape.form != GaugeForm::scalar && setting.shape.n > 1)
    throw UsageError("--map draws one beta and one gamma: --gauge-form scalar");
  Tuner tuner(options, setting);
  const std::optional<TuneReport> report = tuner.run();
  if (interrupt_flag()) return interrupted;
  if (!report) return numerical_failure;
  print(options.json ? tune_json(*report) : tune_text(*report));
  if (!options.map.empty()) {
    const EnergyMap map = tuner.map(map_options);
    if (interrupt_flag()) {
      print_error("hamgen: stopped; no map was written\n");
      return interrupted;
    }
    write_map(options, map, *report);
  }
  return report->gauges.back().measured.failure.empty() ? done : numerical_failure;
}

}  // namespace

Command add_tune(CLI::App& app) {
  const auto options = std::make_shared<TuneOptions>();
  CLI::App* parser =
      app.add_subcommand("tune", "finds constant beta, gamma that flatten the energy of one orbit");
  parser->add_option("MODEL", options->model, "a .ham file")->required();
  add_scene_options(*parser, options->scene);
  parser->add_option("--h", options->h, "step size; default: the scene's")->type_name("H");
  parser->add_option("--time", options->time, "default: the scene's, at most 5000 steps")
      ->type_name("T");
  parser->add_option("--gauge-form", options->form, "scalar (default), diagonal or matrix")
      ->type_name("FORM");
  parser->add_option("--samples", options->samples, "points of the orbit to fit; default 1000")
      ->type_name("N");
  parser->add_flag("--polish", options->polish, "then minimise the measured energy spread");
  parser->add_option("--scalar", options->scalar, "of the runs; default double")->type_name("TYPE");
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
  parser->add_option("--compiler", options->compiler, "default: $CXX, else g++, else clang++")
      ->type_name("PROGRAM");
  return {parser, [options] { return run_tune(*options); }};
}

}  // namespace hamgen::app
