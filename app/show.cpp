// hamgen show: the value of one stage of the pipeline as text.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "app/command_line.hpp"
#include "app/output/json_document.hpp"
#include "app/output/model_json.hpp"
#include "app/output/terminal.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"

namespace hamgen::app {
namespace {

constexpr std::array<std::string_view, 6> stages = {"model", "mechanics", "equations",
                                                    "plan",  "program",   "origins"};

int show(const MethodOptions& options, const SceneOptions& scene, const std::string& stage,
         bool json) {
  if (std::ranges::find(stages, stage) == stages.end())
    throw UsageError(fmt::format("--stage {}: no such stage\nhelp: the stages are {}", stage,
                                 fmt::join(stages, ", ")));
  const SourceText source = read_source(options.model);
  const Request request = request_of(options, scene, source);
  std::string text = show_stage(source, request, stage);
  if (!text.ends_with('\n')) text += '\n';
  if (json) {
    const Model model = read_model(source, request.sizes);
    text = json_document(nlohmann::ordered_json{
        {"file", source.path}, {"stage", stage}, {"model", model_json(model)}, {"text", text}});
  }
  print(text);
  return done;
}

}  // namespace

Command add_show(CLI::App& app) {
  const auto options = std::make_shared<MethodOptions>();
  const auto scene = std::make_shared<SceneOptions>();
  const auto stage = std::make_shared<std::string>("plan");
  const auto json = std::make_shared<bool>(false);
  CLI::App* parser =
      app.add_subcommand("show", "prints what one stage of the pipeline makes of a model");
  parser
      ->add_option("--stage", *stage,
                   "model, mechanics, equations, plan (default), program, origins")
      ->type_name("NAME");
  add_method_options(*parser, *options);
  add_scene_choice(*parser, *scene);
  parser->add_flag("--json", *json, "the text, and the model with its names, units and scenes");
  return {parser, [options, scene, stage, json] { return show(*options, *scene, *stage, *json); }};
}

}  // namespace hamgen::app
