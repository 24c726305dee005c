// hamgen chaos: is an orbit regular, is a region?
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "app/axis_option.hpp"
#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/chaos_output.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress_bars.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "app/studies/scheme_spec.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/pieces.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::app {
namespace {

struct ChaosOptions {
  MethodOptions method;
  SceneOptions scene;
  std::vector<std::string> over;
  std::string indicator, frequencies;  // empty where not asked for
  std::string output, plot;
  CompilerChoice compiler;
  bool spectrum = false;
  bool json = false;
  bool quiet = false;
};

ChaosAxis read_axis(const std::string& text, const std::set<std::string>& names) {
  const AxisOption option = read_axis_option(text, names, 2, 10'000);
  ChaosAxis axis{.name = option.name, .values = {}};
  for (long long i = 0; i < option.count; ++i)
    axis.values.push_back(option.low + (option.high - option.low) * static_cast<double>(i) /
                                           static_cast<double>(option.count - 1));
  return axis;
}

const Indicator& read_indicator(const std::string& asked) {
  const std::string name = asked.empty() ? "megno" : asked;
  std::string known;
  for (const Indicator& each : all_indicators()) {
    if (each.name == name) return each;
    known += (known.empty() ? "" : ", ") + each.name;
  }
  throw UsageError(fmt::format("--indicator {}: there are {}", name, known));
}

// What is of an orbit alone, and of a map alone.
void require_for_what(const ChaosOptions& options) {
  if (!options.over.empty() && options.spectrum)
    throw UsageError("--spectrum: of one orbit; a map (--over) has no place for all exponents");
  if (!options.over.empty() && !options.frequencies.empty())
    throw UsageError("--frequencies: of one orbit; a map (--over) has no place for them");
  if (options.over.empty() && !options.indicator.empty())
    throw UsageError(
        fmt::format("--indicator {}: of a map; one orbit has all of them\n"
                    "help: a map is asked for by --over NAME=LOW:HIGH:COUNT",
                    options.indicator));
}

int read_count(const std::string& frequencies) {
  constexpr long most = 20;
  if (frequencies.empty()) return 0;
  const std::string option = "--frequencies " + frequencies;
  const long count = integer_value(option, frequencies, 0);
  if (count > most) throw UsageError(fmt::format("{}: {} at most", option, most));
  return static_cast<int>(count);
}

struct Loaded {
  Setting setting;
  SceneValues scene;
  PluginSource plugin;
  runtime::LoadedPlugin library;
};

// The step with its tangent map, of all of the model: a deviation need not stay where the orbit
// does.
Loaded load(const ChaosOptions& options, Setting setting, const std::vector<std::string>& names,
            const std::vector<ChaosAxis>& axes) {
  Loaded loaded;
  loaded.setting = std::move(setting);
  loaded.scene = complete_scene(loaded.setting.model, loaded.setting.scene);
  if (*loaded.scene.steps < 1)
    throw UsageError("deviations grow in steps, and there are none\nhelp: --steps 10000");
  take_gauge_at(loaded.scene, loaded.setting.model, loaded.setting.request);
  specialise(options.scene, loaded.scene, names, Observing::everything, loaded.setting);
  loaded.setting.request.tangent = true;
  loaded.plugin = generate_plugin(loaded.setting.source, loaded.setting.request);
  if (!loaded.plugin.without_tangent.empty())
    throw UsageError(
        fmt::format("chaos is measured with the step's tangent map, and there is none: "
                    "{}\nhelp: another --scheme",
                    loaded.plugin.without_tangent));
  // The tangent map is that of so many deviations.
  auto orbits = static_cast<double>(1 + 2 * loaded.scene.q.size());
  std::vector<std::string> varied;
  for (const ChaosAxis& axis : axes) {
    orbits *= static_cast<double>(axis.values.size());
    varied.push_back(axis.name);
  }
  const double steps =
      steps_of_all(loaded.setting.model, loaded.setting.scene, loaded.scene, varied, orbits);
  loaded.library = load_integrator(loaded.plugin, options.compiler, &interrupt_flag(), steps);
  return loaded;
}

ChaosTitle title_of(const Loaded& loaded) {
  return {.model = loaded.setting.model.name,
          .scene = loaded.scene.name,
          .scheme = method_text(loaded.plugin),
          .h = to_double(*loaded.scene.h),
          .coordinates = element_names(loaded.setting.model.coordinates)};
}

// The text for people, the document of --json, and the table.
struct ChaosTexts {
  std::string people, json, csv;
};

void write_chaos_files(const ChaosOptions& options, const ChaosTexts& texts,
                       const std::string& script) {
  make_directories_above({options.output, options.plot}, options.quiet);
  const OutputKind kind = table_kind(options.output);
  print(options.json ? texts.json : kind == OutputKind::standard ? texts.csv : texts.people);
  if (kind == OutputKind::csv || kind == OutputKind::json) {
    runtime::atomic_write(options.output, kind == OutputKind::csv ? texts.csv : texts.json);
    if (!options.quiet) print_error(options.output + "\n");
  }
  if (options.plot.empty()) return;
  draw_picture({.picture = options.plot,
                .script = std::filesystem::path(options.plot).replace_extension(".gp"),
                .text = script},
               options.quiet, &interrupt_flag());
}

int run_map(const ChaosOptions& options, const Loaded& loaded, const Indicator& indicator,
            const std::vector<ChaosAxis>& axes) {
  const long all =
      static_cast<long>(axes[0].values.size() * (axes.size() > 1 ? axes[1].values.size() : 1));
  std::vector<ChaosCell> cells;
  {
    Work work(progress_bars(options.quiet), "map", all);
    cells = chaos_map({.plugin = &loaded.plugin,
                       .library = loaded.library.library,
                       .scene = loaded.setting.scene,
                       .axes = axes,
                       .on_progress = [&work](long done) { work.tell(done); },
                       .stop = &interrupt_flag()});
  }
  if (interrupt_flag()) {
    print_error("hamgen: stopped; nothing was written\n");
    return interrupted;
  }
  const ChaosMapTable map{&axes, &cells};
  const ChaosTitle title = title_of(loaded);
  write_chaos_files(options,
                    {.people = chaos_map_text(map, indicator, title),
                     .json = chaos_map_json(map, title),
                     .csv = chaos_map_csv(map, title)},
                    chaos_map_script(map, indicator, title, options.plot));
  if (options.output.empty() && options.plot.empty() && !options.json && !options.quiet)
    print_error("  The cells are not kept: --plot map.svg draws them, -o map.csv writes them.\n");
  return std::ranges::any_of(cells,
                             [](const ChaosCell& c) { return c.status == runtime::Status::done; })
             ? done
             : numerical_failure;
}

int run_orbit(const ChaosOptions& options, const Loaded& loaded, int frequencies) {
  const runtime::InitialValues start =
      initial_values(loaded.plugin, loaded.scene, *loaded.library.library);
  const long steps = *loaded.scene.steps;
  Chaos found;
  {
    Work work(progress_bars(options.quiet), "deviations", steps, true);
    found = chaos({.library = loaded.library.library,
                   .start = start,
                   .steps = steps,
                   .spectrum = options.spectrum,
                   .on_progress = [&work](long done) { work.tell(done); },
                   .stop = &interrupt_flag()});
  }
  std::vector<DegreeFrequencies> degrees;
  if (frequencies > 0 && found.status == runtime::Status::done)
    degrees =
        orbit_frequencies(loaded.library.library, start, steps, frequencies, &interrupt_flag());
  // Time goes on, and its momentum has the frequencies of the rest.
  if (!degrees.empty() && loaded.setting.model.coordinates.back().is_time) degrees.pop_back();
  const ChaosTitle title = title_of(loaded);
  write_chaos_files(options,
                    {.people = chaos_text(found, title) + frequencies_text(degrees, title),
                     .json = chaos_json(found, degrees, title),
                     .csv = chaos_csv(found, degrees, title)},
                    gnuplot_script(chaos_plot(found, title), options.plot));
  if (found.status == runtime::Status::stopped) return interrupted;
  return found.status == runtime::Status::done ? done : numerical_failure;
}

int run_chaos(const ChaosOptions& options) {
  if (!options.plot.empty() && !options.plot.ends_with(".svg") && !options.plot.ends_with(".png"))
    throw UsageError(fmt::format("--plot {}: the name ends in .svg or .png", options.plot));
  require_one_document(options.json, table_kind(options.output));
  require_for_what(options);
  const Indicator& indicator = read_indicator(options.indicator);
  const int frequencies = read_count(options.frequencies);
  require_writable({options.output, options.plot});
  Setting setting = read_setting(options.method, options.scene);
  const std::set<std::string> names = varied_names(setting.model);
  std::vector<ChaosAxis> axes;
  for (const std::string& text : options.over) {
    for (const std::string_view piece : outermost_pieces(text))
      axes.push_back(read_axis(std::string(piece), names));
  }
  std::vector<std::string> varied;
  for (const ChaosAxis& axis : axes) varied.push_back(axis.name);
  require_set_once(setting.scene, varied);
  require_not_folded(listed("--fold", options.method.fold), varied);
  if (axes.size() > 2) throw UsageError("--over: two axes at most");
  if (axes.size() == 2 && axes[0].name == axes[1].name)
    throw UsageError(fmt::format("--over: both axes are {}", axes[0].name));
  constexpr std::size_t most = 1'000'000;
  if (axes.size() == 2 && axes[0].values.size() * axes[1].values.size() > most)
    throw UsageError(
        fmt::format("--over: {} orbits, more than the {} of a map\n"
                    "help: smaller COUNTs: a picture of 1000 by 1000 is a fine one",
                    axes[0].values.size() * axes[1].values.size(), most));
  const Loaded loaded = load(options, std::move(setting), {names.begin(), names.end()}, axes);
  return axes.empty() ? run_orbit(options, loaded, frequencies)
                      : run_map(options, loaded, indicator, axes);
}

}  // namespace

Command add_chaos(CLI::App& app) {
  const auto options = std::make_shared<ChaosOptions>();
  CLI::App* parser = app.add_subcommand(
      "chaos", "Lyapunov exponents, MEGNO, FLI, SALI and frequencies, of an orbit or over a plane");
  add_scene_options(*parser, options->scene);
  parser->add_flag("--spectrum", options->spectrum, "");
  parser
      ->add_option("--frequencies", options->frequencies,
                   "all Lyapunov exponents; leading frequencies of each q + ip")
      ->type_name("COUNT");
  add_repeated(*parser, "--over", options->over,
               "an axis of a map: a parameter or variable; twice at most")
      ->type_name("NAME=LOW:HIGH:COUNT,...");
  parser
      ->add_option("--indicator", options->indicator,
                   "of a map: megno (default), lyapunov, fli or sali")
      ->type_name("NAME");
  add_step_option(*parser, options->scene);
  parser->add_option("--time", options->scene.time, "")->type_name("T");
  parser->add_option("--steps", options->scene.steps, "time, or number of steps, of each orbit")
      ->type_name("N");
  parser->add_option("-o,--output", options->output, "")->type_name("FILE");
  parser
      ->add_option("--plot", options->plot,
                   "the numbers: .csv, .json; a picture: .svg, .png, and its .gp")
      ->type_name("FILE");
  parser->add_flag("--json", options->json, "");
  parser->add_flag("--quiet", options->quiet,
                   "the numbers as JSON; no progress, no names of files");
  add_method_options(*parser, options->method);
  add_compiler_options(*parser, options->compiler);
  return {parser, [options] { return run_chaos(*options); }};
}

}  // namespace hamgen::app
