// hamgen check: is the model fine, up to the text of its step?
#include <fmt/format.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "app/command_line.hpp"
#include "app/output/json_document.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/domain.hpp"
#include "app/studies/initial_data.hpp"
#include "app/studies/interpreted.hpp"
#include "generator/algebra/scalar.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "generator/language/read_model.hpp"
#include "generator/language/scene.hpp"

namespace hamgen::app {
namespace {

std::string counted(long count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

// Of a larger system a scene has as many formulas to evaluate: seconds, when it is run.
constexpr long largest_checked_scene = 100'000;

// Evaluates every scene, so that a mistake in one nobody runs is found too.
std::vector<SceneValues> values_of_scenes(const Model& model, const ScalarType& scalar) {
  std::vector<SceneValues> scenes;
  if (degrees_of_freedom(model) > largest_checked_scene) return scenes;
  std::vector<Diagnostic> mistakes;
  for (const Scene& scene : model.scenes) {
    try {
      scenes.push_back(values_of_scene(model, scene));
      require_in_range(model, scenes.back(), scalar);
    } catch (const ModelError& error) {
      mistakes.insert(mistakes.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  if (!mistakes.empty()) throw ModelError(mistakes, model.source);
  return scenes;
}

// Where H or its gradient has no value at the start, whatever the method is: an explicit step takes
// any H, of any size, and solves nothing.  No mistakes: a run may be given another state.
std::vector<Diagnostic> undefined_starts(const Model& model, std::vector<SceneValues> scenes,
                                         const Request& request) {
  std::vector<Diagnostic> found;
  if (scenes.empty() || is_defined_everywhere(model)) return found;
  Request plain;
  plain.scheme = "explicit-euler";
  plain.scalar = request.scalar;
  plain.sizes = request.sizes;
  const PluginSource plugin = generate_plugin(model.source, plain);
  const runtime::LoadedPlugin integrator = interpreted_integrator(model.source, plain, plugin);
  for (SceneValues& scene : scenes) {
    if (!scene.h) scene.h = 1;
    try {
      static_cast<void>(initial_values(plugin, scene, *integrator.library));
    } catch (const ModelError& error) {
      found.insert(found.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  for (Diagnostic& each : found) each.severity = Severity::warning;
  return found;
}

// Throws ModelError where the model is not fine.  What it warns of is told as it is found.
Model check_model(const SourceText& source, const Request& request,
                  const std::function<void(const std::vector<Diagnostic>&)>& warn) {
  Model model = read_model(source, request.sizes);
  if (!model.warnings.empty()) warn(model.warnings);
  std::vector<SceneValues> scenes = values_of_scenes(model, *request.scalar->type);
  check_step(source, request);
  if (const auto undefined = undefined_starts(model, std::move(scenes), request);
      !undefined.empty())
    warn(undefined);
  for (const Corner& corner : corners_of_hamiltonian(source, request)) {
    warn({{.severity = Severity::warning,
           .span = model.hamiltonian->span,
           .message = fmt::format("H has a corner where {}, by {}", corner.place,
                                  to_text(corner.function)),
           .help = "a step across it is of low order, and what `hamgen verify` says holds off the "
                   "corner"}});
  }
  if (const std::string place = point_beyond_text(source, request); !place.empty()) {
    warn({{.severity = Severity::warning,
           .span = model.hamiltonian->span,
           .message = fmt::format("something cancels in H: at {} it has no value as it is written, "
                                  "but what is emitted has one",
                                  place),
           .help = "steps go on there; write H without what cancels"}});
  }
  return model;
}

struct Counts {
  long degrees_of_freedom, parameters, invariants, scenes;
};

Counts counts_of(const Model& model) {
  return {degrees_of_freedom(model), static_cast<long>(element_names(model.parameters).size()),
          static_cast<long>(model.invariants.size()), static_cast<long>(model.scenes.size())};
}

nlohmann::ordered_json json_of(const Diagnostic& diagnostic, const Location& place) {
  return {{"severity", diagnostic.severity == Severity::error ? "error" : "warning"},
          {"file", place.file},
          {"line", place.begin.line},
          {"column", place.begin.column},
          {"end_line", place.end.line},
          {"end_column", place.end.column},
          {"message", diagnostic.message},
          {"help", diagnostic.help}};
}

// Of options that make no sense: no place is meant.
nlohmann::ordered_json json_of(const UsageError& error) {
  const std::string text = error.what();
  const std::size_t help = text.find("\nhelp: ");
  Diagnostic said{
      .severity = Severity::error, .span = {}, .message = text.substr(0, help), .help = ""};
  if (help != std::string::npos) said.help = text.substr(help + 7);
  return json_of(said, {.file = "", .begin = {1, 1}, .end = {1, 1}});
}

// For editors: everything that is said, as one document, and nothing else.
int check_as_json(const SourceText& source, const MethodOptions& options,
                  const SceneOptions& scene) {
  nlohmann::ordered_json document = {{"model", source.path}, {"fine", false}};
  nlohmann::ordered_json said = nlohmann::ordered_json::array();
  const auto say = [&said](const auto& error) {
    for (std::size_t i = 0; i < error.diagnostics().size(); ++i)
      said.push_back(json_of(error.diagnostics()[i], error.locations()[i]));
  };
  int status = done;
  try {
    const Request request = request_of(options, scene, source);
    const Model model = check_model(source, request, [&](const std::vector<Diagnostic>& warnings) {
      for (const Diagnostic& each : warnings)
        said.push_back(json_of(each, location_of(each, source)));
    });
    const Counts counts = counts_of(model);
    document["fine"] = true;
    document["degrees_of_freedom"] = counts.degrees_of_freedom;
    document["parameters"] = counts.parameters;
    document["invariants"] = counts.invariants;
    document["scenes"] = counts.scenes;
  } catch (const ModelError& error) {
    say(error);
    status = model_error;
  } catch (const OptionError& error) {
    say(error);
    status = usage_error;
  } catch (const UsageError& error) {
    said.push_back(json_of(error));
    status = usage_error;
  }
  document["diagnostics"] = std::move(said);
  print(json_document(document));
  return status;
}

int check(const MethodOptions& options, const SceneOptions& scene, bool json, bool quiet) {
  const SourceText source = read_source(options.model);
  if (json) return check_as_json(source, options, scene);
  const Request request = request_of(options, scene, source);
  const Model model = check_model(source, request, [&](const std::vector<Diagnostic>& warnings) {
    print_error(render(warnings, source));
  });
  if (quiet) return done;
  const Counts counts = counts_of(model);
  print(fmt::format("{}: fine: {}, {}, {}, {}\n", visible_text(options.model),
                    counted(counts.degrees_of_freedom, "degree of freedom", "degrees of freedom"),
                    counted(counts.parameters, "parameter", "parameters"),
                    counted(counts.invariants, "invariant", "invariants"),
                    counted(counts.scenes, "scene", "scenes")));
  return done;
}

}  // namespace

Command add_check(CLI::App& app) {
  const auto options = std::make_shared<MethodOptions>();
  const auto scene = std::make_shared<SceneOptions>();
  const auto json = std::make_shared<bool>(false);
  const auto quiet = std::make_shared<bool>(false);
  CLI::App* parser = app.add_subcommand(
      "check", "says whether a model is fine: language, derivatives, scenes, plan of the step");
  add_method_options(*parser, *options);
  add_scene_choice(*parser, *scene);
  parser->add_flag("--json", *json, "");
  parser->add_flag("--quiet", *quiet, "what is said, with its places, for editors; mistakes only");
  return {parser, [options, scene, json, quiet] { return check(*options, *scene, *json, *quiet); }};
}

}  // namespace hamgen::app
