// hamgen check: is the model fine, up to the text of its step?
#include <fmt/format.h>

#include <memory>

#include "app/command_line.hpp"
#include "app/output/terminal.hpp"
#include "app/studies/initial_data.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "generator/formats/scalar.hpp"
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
void check_scenes(const Model& model, const ScalarType& scalar) {
  if (degrees_of_freedom(model) > largest_checked_scene) return;
  std::vector<Diagnostic> mistakes;
  for (const Scene& scene : model.scenes) {
    try {
      require_in_range(model, values_of_scene(model, scene), scalar);
    } catch (const ModelError& error) {
      mistakes.insert(mistakes.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  if (!mistakes.empty()) throw ModelError(mistakes, model.source);
}

int check(const MethodOptions& options, const SceneOptions& scene) {
  const SourceText source = read_source(options.model);
  const Request request = request_of(options, scene, source);
  const Model model = read_model(source, request.sizes);
  if (!model.warnings.empty()) print_error(render(model.warnings, source));
  check_scenes(model, find_scalar(request.scalar));
  check_step(source, request);
  for (const Corner& corner : corners_of_hamiltonian(source, request)) {
    const Diagnostic warning{
        .severity = Severity::warning,
        .span = model.hamiltonian->span,
        .message =
            fmt::format("H has a corner where {}, by {}", corner.place, to_text(corner.function)),
        .help =
            "a step across it is of low order, and what `hamgen verify` says holds off the "
            "corner"};
    print_error(render({warning}, source));
  }
  if (const std::string place = point_beyond_text(source, request); !place.empty()) {
    const Diagnostic warning{
        .severity = Severity::warning,
        .span = model.hamiltonian->span,
        .message = fmt::format("something cancels in H: at {} it has no value as it is written, "
                               "but what is emitted has one",
                               place),
        .help = "steps go on there; write H without what cancels"};
    print_error(render({warning}, source));
  }
  print(fmt::format(
      "{}: fine: {}, {}, {}, {}\n", visible_text(options.model),
      counted(degrees_of_freedom(model), "degree of freedom", "degrees of freedom"),
      counted(static_cast<long>(element_names(model.parameters).size()), "parameter", "parameters"),
      counted(static_cast<long>(model.invariants.size()), "invariant", "invariants"),
      counted(static_cast<long>(model.scenes.size()), "scene", "scenes")));
  return done;
}

}  // namespace

Command add_check(CLI::App& app) {
  const auto options = std::make_shared<MethodOptions>();
  const auto scene = std::make_shared<SceneOptions>();
  CLI::App* parser = app.add_subcommand(
      "check", "says whether a model is fine: language, derivatives, scenes, plan of the step");
  add_method_options(*parser, *options);
  add_scene_choice(*parser, *scene);
  return {parser, [options, scene] { return check(*options, *scene); }};
}

}  // namespace hamgen::app
