// hamgen section: where orbits of one energy cross a surface.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/draw_picture.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress_bars.hpp"
#include "app/output/section_output.hpp"
#include "app/output/terminal.hpp"
#include "app/output/trajectory_plot.hpp"
#include "app/studies/angles.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "app/studies/natural_sizes.hpp"
#include "app/studies/scheme_spec.hpp"
#include "app/studies/section_starts.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/pieces.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::app {
namespace {

struct SectionOptions {
  MethodOptions method;
  SceneOptions scene;
  std::string surface, axes, from, energy;
  std::string direction = "rising";
  std::string orbits = "24";
  std::string points = "400";
  std::string output, plot;
  CompilerChoice compiler;
  bool json = false;
  bool quiet = false;
};

runtime::Direction read_direction(const std::string& text) {
  if (text == "rising") return runtime::Direction::rising;
  if (text == "falling") return runtime::Direction::falling;
  if (text == "both") return runtime::Direction::both;
  throw UsageError(fmt::format("--direction {}: rising, falling or both", text));
}

std::string blankless(std::string_view text) { return std::string(without_blanks(text)); }

// "x = 0.3" as its two sides; without '=' the right one is 0.
std::pair<std::string, std::string> sides(const std::string& surface) {
  if (outermost_pieces(surface).size() != 1)
    throw UsageError(fmt::format(
        "--surface {}: one equation is wanted\nhelp: for example --surface 'q1 = 0'", surface));
  const std::size_t equals = surface.find('=');
  if (equals == std::string::npos) return {blankless(surface), "0"};
  return {blankless(surface.substr(0, equals)), blankless(surface.substr(equals + 1))};
}

std::size_t place_of(const std::vector<std::string>& names, const std::string& name,
                     const std::string& option) {
  const auto it = std::ranges::find(names, name);
  if (it != names.end()) return static_cast<std::size_t>(it - names.begin());
  const std::string near = nearest(name, names);
  throw UsageError(fmt::format("{} {}: the model has no such coordinate or momentum{}", option,
                               name, near.empty() ? "" : "; did you mean '" + near + "'?"));
}

// What the options leave open: the surface is the first coordinate's zero, the axes are another
// pair.
struct Geometry {
  std::vector<std::string> names;  // of the state
  std::string left, right;         // of the surface
  std::string first, second;       // the axes
};

// Has the right side of the surface one value?
bool is_constant(const Geometry& g) {
  return std::ranges::none_of(
      g.names, [&](const std::string& name) { return g.right.find(name) != std::string::npos; });
}

// A picture of a section has two directions.
void require_plane(const SectionOptions& options, const Geometry& g) {
  if (g.first == g.second)
    throw UsageError(fmt::format("--axes {}: both are {}", options.axes, g.first));
  for (const std::string& axis : {g.first, g.second}) {
    if (axis == g.left && is_constant(g))
      throw UsageError(fmt::format("--axes {}: {} is {} on the surface everywhere", options.axes,
                                   axis, g.right));
  }
}

Geometry geometry(const SectionOptions& options, const Model& model) {
  Geometry g;
  g.names = element_names(model.coordinates);
  const std::size_t n = g.names.size();
  std::ranges::copy(element_names(model.momenta), std::back_inserter(g.names));
  std::tie(g.left, g.right) =
      options.surface.empty() ? std::pair(g.names[0], std::string("0")) : sides(options.surface);
  if (!options.axes.empty()) {
    const auto pieces = outermost_pieces(options.axes);
    if (pieces.size() != 2)
      throw UsageError(fmt::format(
          "--axes {}: two quantities are wanted\nhelp: for example --axes q2,p2", options.axes));
    g.first = blankless(pieces[0]);
    g.second = blankless(pieces[1]);
    require_plane(options, g);
    return g;
  }
  const std::size_t pair = n > 1 && g.left == g.names[0] ? 1 : 0;
  g.first = g.names[pair];
  g.second = g.names[n + pair];
  return g;
}

// LOW:HIGH of the axis.
std::pair<double, double> interval(const SectionOptions& options, const Geometry& g,
                                   const std::string& axis) {
  for (const Assignment& each : split_assignments("--from", options.from)) {
    if (each.first != axis) continue;
    const std::size_t colon = each.second.find(':');
    if (colon == std::string::npos) break;
    const double low = to_double(constant_option("--from", each.second.substr(0, colon)));
    const double high = to_double(constant_option("--from", each.second.substr(colon + 1)));
    if (low < high) return {low, high};
    throw UsageError(fmt::format("--from {}={}: the lower end comes first", axis, each.second));
  }
  throw UsageError(
      fmt::format("--from {}: a range of both axes is wanted\nhelp: --from "
                  "'{}=-1:1,{}=-1:1'",
                  options.from, g.first, g.second));
}

// Of the variable that the surface fixes where orbits start.
double surface_value(const Geometry& g) {
  try {
    return to_double(constant_option("--surface", g.right));
  } catch (const ModelError&) {
    throw UsageError(
        fmt::format("--surface {} = {}: orbits start where {} has a value, and this is none\n"
                    "help: --orbits 0 follows the scene's own orbit",
                    g.left, g.right, g.left));
  }
}

// Of both axes, and of each once.
void require_intervals(const SectionOptions& options, const Geometry& g) {
  std::set<std::string> seen;
  for (const Assignment& each : split_assignments("--from", options.from)) {
    if (each.first != g.first && each.first != g.second)
      throw UsageError(
          fmt::format("--from {}={}: this is none of the axes {} and {}\n"
                      "help: other variables have one value, by --initial",
                      each.first, each.second, g.first, g.second));
    if (!seen.insert(each.first).second)
      throw UsageError(fmt::format("--from: {} has two ranges", each.first));
  }
}

// Starts are drawn in the plane of the axes, which then are variables.
void read_starts(const SectionOptions& options, const Geometry& g, SectionRequest& request) {
  constexpr long kMostOrbits = 100'000;  // more lie in memory together than a picture can show
  const long orbits = integer_value("--orbits " + options.orbits, options.orbits, 0);
  if (orbits > kMostOrbits)
    throw UsageError(fmt::format("--orbits {}: {} at most", options.orbits, kMostOrbits));
  request.orbits = static_cast<int>(orbits);
  request.points = integer_value("--points " + options.points, options.points, 1);
  if (request.orbits == 0) {
    // Then there is nothing to start.
    for (const auto& [name, text] :
         {std::pair("--from", options.from), {"--energy", options.energy}})
      if (!text.empty())
        throw UsageError(fmt::format(
            "{} {}: --orbits 0 is the scene's own orbit, with its start and energy", name, text));
    return;
  }
  const std::string option = options.axes.empty() ? "--surface" : "--axes";
  request.first = place_of(g.names, g.first, option);
  request.second = place_of(g.names, g.second, option);
  const std::size_t n = g.names.size() / 2;
  std::size_t of_surface = g.names.size();
  if (const auto it = std::ranges::find(g.names, g.left); it != g.names.end()) {
    of_surface = static_cast<std::size_t>(it - g.names.begin());
    request.fixed = {of_surface, surface_value(g)};
  }
  const auto taken = [&](std::size_t place) {
    return place == request.first || place == request.second || place == of_surface;
  };
  request.momentum = of_surface < n ? of_surface + n : n;
  while (request.momentum < 2 * n && taken(request.momentum)) ++request.momentum;
  if (request.momentum == 2 * n)
    throw UsageError(fmt::format(
        "no momentum is left that could give the energy: the axes are {} and {}\nhelp: other "
        "--axes, or --orbits 0 for the scene's own orbit",
        g.first, g.second));
  if (options.from.empty()) return;
  require_intervals(options, g);
  const auto [x, right] = interval(options, g, g.first);
  const auto [y, top] = interval(options, g, g.second);
  request.box = {x, right, y, top};
}

std::optional<double> read_energy(const SectionOptions& options) {
  if (options.energy.empty()) return std::nullopt;
  return to_double(constant_option("--energy", options.energy));
}

// With mistakes in what it looks at called by the options they come from.
SceneValues scene_of(const Setting& setting) {
  try {
    return complete_scene(setting.model, setting.scene);
  } catch (const UsageError& error) {
    std::string text = error.what();
    if (text.starts_with("--observe")) text.replace(0, text.find(' '), "--surface or --axes:");
    throw UsageError(text);
  }
}

void write_files(const SectionOptions& options, const Section& section, const SectionTitle& title) {
  make_directories_above({options.output, options.plot}, options.quiet);
  const OutputKind kind = table_kind(options.output);
  if (kind == OutputKind::standard) print(section_csv(section, title));
  if (kind == OutputKind::csv || kind == OutputKind::json) {
    runtime::atomic_write(options.output, kind == OutputKind::csv ? section_csv(section, title)
                                                                  : section_json(section, title));
    if (!options.quiet) print_error(options.output + "\n");
  }
  if (options.plot.empty()) return;
  draw_picture({.picture = options.plot,
                .script = std::filesystem::path(options.plot).replace_extension(".gp"),
                .text = gnuplot_script(section_plot(section, title), options.plot)},
               options.quiet, &interrupt_flag());
}

// Of a name that is a coordinate: is it an angle?
std::function<bool(const std::string&)> angles_of(const SectionRequest& request,
                                                  const std::vector<std::string>& names) {
  return [&names,
          are = angles(*request.library, request.start, request.sizes)](const std::string& name) {
    const auto it = std::ranges::find(names, name);
    const auto place = static_cast<std::size_t>(it - names.begin());
    return place < are.size() && are[place];
  };
}

std::vector<std::string> angle_axes(const SectionRequest& request, const Geometry& g) {
  std::vector<std::string> names;
  if (request.first_turns) names.push_back(g.first);
  if (request.second_turns) names.push_back(g.second);
  return names;
}

// Failures of the step; an orbit may well escape.
bool has_failed(const SectionOrbit& orbit) {
  return orbit.status != runtime::Status::done && orbit.status != runtime::Status::escaped;
}

int run_section(const SectionOptions& options) {
  if (!options.plot.empty()) require_picture_name("--plot", options.plot);
  require_one_document(options.json, table_kind(options.output));
  require_writable({options.output, options.plot});
  const runtime::Direction direction = read_direction(options.direction);
  SceneOptions scene_options = options.scene;
  if (!scene_options.steps && !scene_options.time) scene_options.steps = "1e6";
  Setting setting = read_setting(options.method, scene_options);
  const Geometry g = geometry(options, setting.model);
  setting.scene.observe = fmt::format("{} = ({}) - ({}), {} = {}, {} = {}", kSurface, g.left,
                                      g.right, kFirstAxis, g.first, kSecondAxis, g.second);
  const SceneValues scene = scene_of(setting);
  SectionRequest request;
  read_starts(options, g, request);
  const std::optional<double> energy = read_energy(options);
  take_gauge_at(scene, setting.model, setting.request);
  scene_options.whole = false;
  std::vector<std::string> varied = g.names;
  std::ranges::copy(element_names(setting.model.parameters), std::back_inserter(varied));
  specialise(scene_options, scene, varied, Observing::as_the_scene, setting);

  const PluginSource plugin = generate_plugin(setting.source, setting.request);
  const double steps = std::max(1, request.orbits) * static_cast<double>(*scene.steps);
  const runtime::LoadedPlugin loaded =
      load_integrator(plugin, options.compiler, &interrupt_flag(), steps);
  request.plugin = &plugin;
  request.library = loaded.library;
  request.start = initial_values(plugin, scene, *loaded.library);
  request.direction = direction;
  request.energy =
      energy.value_or(loaded.library->energy(request.start.parameters, request.start.state).hi);
  request.sizes = natural_sizes(*request.library, request.start);
  if (request.orbits > 0) {
    if (const double moves = energy_of_momentum(request); moves > 0.0)
      request.sizes = natural_sizes(*request.library, request.start, moves);
  }
  const auto is_angle = angles_of(request, g.names);
  request.turns = is_angle(g.left) && is_constant(g);
  request.first_turns = is_angle(g.first);
  request.second_turns = is_angle(g.second);
  request.steps = *scene.steps;
  Work work(progress_bars(options.quiet), "section", std::max(1, request.orbits));
  request.on_progress = [&work](int done, int) { work.tell(done); };
  request.stop = &interrupt_flag();

  const Section result = section(request);
  const SectionTitle title{
      .model = setting.model.name,
      .scene = scene.name,
      .scheme = method_text(plugin),
      .surface =
          fmt::format("{} = {}{}, {}", g.left, g.right, request.turns ? " (mod 2 pi)" : "",
                      direction == runtime::Direction::both ? "both ways" : options.direction),
      .first = g.first,
      .second = g.second,
      .angles = angle_axes(request, g),
      .energy = request.energy,
      .h = request.start.h.hi};
  if (!options.quiet) print_error(section_summary(result, title));
  if (options.json) print(section_json(result, title));
  write_files(options, result, title);
  if (options.output.empty() && options.plot.empty() && !options.json && !options.quiet)
    print_error(
        "  The points are not kept: --plot section.svg draws them, -o section.csv writes them.\n");
  if (interrupt_flag()) return interrupted;
  const bool crossed = std::ranges::any_of(
      result.orbits, [](const SectionOrbit& orbit) { return !orbit.points.empty(); });
  return crossed && std::ranges::none_of(result.orbits, has_failed) ? done : numerical_failure;
}

}  // namespace

Command add_section(CLI::App& app) {
  const auto options = std::make_shared<SectionOptions>();
  CLI::App* parser =
      app.add_subcommand("section", "Poincare section: where orbits of one energy cross a surface");
  add_scene_options(*parser, options->scene);
  parser->add_option("--surface", options->surface, "")->type_name("EQUATION");
  parser
      ->add_option("--axes", options->axes,
                   "where, 'q1 = 0', and what is drawn; default: by the model")
      ->type_name("A,B");
  parser->add_option("--direction", options->direction, "")->type_name("WAY");
  parser
      ->add_option("--energy", options->energy,
                   "rising, falling or both; of all orbits, default: the scene's")
      ->type_name("E");
  parser->add_option("--orbits", options->orbits, "")->type_name("N");
  parser->add_option("--points", options->points, "default 24, or 0: the scene's; default 400 each")
      ->type_name("N");
  parser->add_option("--from", options->from, "where they start")
      ->type_name("A=LOW:HIGH,B=LOW:HIGH");
  parser->add_option("--h", options->scene.h, "")->type_name("H");
  parser->add_option("--time", options->scene.time, "")->type_name("T");
  parser
      ->add_option("--steps", options->scene.steps,
                   "step size; most for an orbit, default 1e6 steps")
      ->type_name("N");
  parser->add_option("-o,--output", options->output, "")->type_name("FILE");
  parser
      ->add_option("--plot", options->plot,
                   "the points: .csv, .json; a picture: .svg, .png, and its .gp")
      ->type_name("FILE");
  parser->add_flag("--json", options->json, "");
  parser->add_flag("--quiet", options->quiet, "the points as JSON; no summary, no progress");
  add_method_options(*parser, options->method);
  add_compiler_options(*parser, options->compiler);
  return {parser, [options] { return run_section(*options); }};
}

}  // namespace hamgen::app
