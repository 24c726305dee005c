// hamgen plugin: what the runtime library's load() takes: the code, and what there is to know of
// it.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "app/command_line.hpp"
#include "app/output/output_name.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/domain.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/orbit_watch.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/facts.hpp"

namespace hamgen::app {
namespace {

struct PluginOptions {
  MethodOptions method;
  SceneOptions scene;
  std::string output;
  bool quiet = false;
};

std::vector<runtime::Wide> wide_values(const std::vector<Rational>& values) {
  std::vector<runtime::Wide> result;
  for (const Rational& value : values) result.push_back(wide(value));
  return result;
}

SceneStart start_of(const PluginSource& plugin, const SceneValues& scene) {
  const std::vector<std::string> names = element_names(plugin.model.parameters);
  SceneStart start;
  for (const std::string& name : plugin.parameter_names) {
    const auto it = std::ranges::find(names, name);
    if (it == names.end()) continue;  // E0
    const auto i = static_cast<std::size_t>(it - names.begin());
    start.parameters.push_back(i < scene.parameters.size() ? wide(scene.parameters[i])
                                                           : runtime::Wide{});
  }
  start.state = wide_values(scene.q);
  std::ranges::copy(wide_values(scene.p), std::back_inserter(start.state));
  if (scene.h) start.h = wide(*scene.h);
  start.steps = scene.steps;
  return start;
}

SystemFacts facts_of(const PluginSource& plugin, std::vector<WatchedEvent> events) {
  const Model& model = plugin.model;
  SystemFacts facts;
  facts.name = model.name;
  facts.scheme = plugin.scheme_name;
  facts.order = plugin.order;
  facts.uses_eigen = plugin.needs_eigen;
  facts.uses_quadmath = plugin.needs_quadmath;
  facts.needs_initial_energy = plugin.needs_energy_parameter;
  facts.defined_everywhere = is_defined_everywhere(model);
  facts.coordinates = element_names(model.coordinates);
  facts.momenta = element_names(model.momenta);
  facts.parameters = plugin.parameter_names;
  if (facts.needs_initial_energy) facts.parameters.pop_back();
  find_places(events, plugin);
  const std::size_t shown = plugin.invariant_names.size() - events.size();
  facts.invariants.assign(plugin.invariant_names.begin(),
                          plugin.invariant_names.begin() + static_cast<std::ptrdiff_t>(shown));
  for (const WatchedEvent& each : events) {
    facts.event_names.push_back(each.what.event.name);
    facts.events.push_back({each.place, direction_of(each.what.event)});
  }
  for (const Scene& scene : model.scenes) {
    if (!scene.mistakes.empty()) continue;  // for other sizes
    facts.scene_names.push_back(scene.name);
    facts.scenes.push_back(start_of(plugin, values_of_scene(model, scene)));
  }
  if (!facts.scenes.empty()) return facts;
  Model without = model;
  without.scenes.clear();
  facts.scenes.push_back(start_of(plugin, scene_values(without, {})));
  return facts;
}

void write(const PluginOptions& options, const std::filesystem::path& path,
           const std::string& text) {
  runtime::atomic_write(path, text);
  if (!options.quiet) print_error(path.string() + "\n");
}

int run_plugin(const PluginOptions& options) {
  require_directory("-o", options.output);
  Setting setting = read_setting(options.method, options.scene);
  const Model& model = setting.model;
  SceneValues scene = scene_values(model, setting.scene);
  std::vector<WatchedEvent> events;
  for (const ModelEvent& each : model.events)
    events.push_back(watch({.event = each}, false, model, scene));
  take_gauge_at(scene, model, setting.request);
  SceneOptions whole = options.scene;
  whole.whole = true;
  specialise(whole, scene, {}, Observing::everything, setting);
  const PluginSource plugin = generate_plugin(setting.source, setting.request);
  const std::filesystem::path directory = options.output;
  make_directories_above({options.output}, options.quiet);
  write(options, directory / "plugin.cpp", plugin.text);
  write(options, directory / "facts.txt", to_text(facts_of(plugin, std::move(events))));
  return done;
}

}  // namespace

Command add_plugin(CLI::App& app) {
  const auto options = std::make_shared<PluginOptions>();
  CLI::App* parser =
      app.add_subcommand("plugin", "writes what a program loads by hamgen::load: code and names");
  parser->add_option("-o,--output", options->output, "where plugin.cpp and facts.txt are written")
      ->type_name("DIRECTORY")
      ->required();
  add_repeated(*parser, "--set", options->scene.set, "sizes of the model")
      ->type_name("NAME=VALUE,...");
  parser->add_flag("--quiet", options->quiet, "no names of files");
  add_method_options(*parser, options->method);
  return {parser, [options] { return run_plugin(*options); }};
}

}  // namespace hamgen::app
