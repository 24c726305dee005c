// Which values follow from others.
#include <algorithm>

#include "generator/language/check_names.hpp"
#include "generator/language/parser.hpp"
#include "generator/language/read_model.hpp"
#include "generator/language/scene.hpp"

namespace hamgen {

std::set<std::string> names_computed_from(const Model& model, const SceneRequest& request,
                                          const std::vector<std::string>& names) {
  std::set<std::string> found(names.begin(), names.end());
  for (const std::string& name : names) found.insert(name.substr(0, name.find('[')));
  std::vector<Setting> settings;
  const auto is_chosen = [&request](const Scene& scene) {
    return request.scene.empty() || scene.name == request.scene;
  };
  const auto chosen = std::ranges::find_if(model.scenes, is_chosen);
  if (chosen != model.scenes.end()) settings = chosen->settings;
  for (const auto* overrides : {&request.set, &request.initial}) {
    for (const auto& [name, value] : *overrides)
      settings.push_back(parse_setting(make_source("option", name + "=" + value)));
  }
  const auto add = [&found](const std::string& name, const std::vector<NodePtr>& values) {
    for (const NodePtr& value : values) {
      const std::set<std::string> used = names_in(value);
      if (std::ranges::any_of(used, [&](const auto& each) { return found.contains(each); }))
        found.insert(name);
    }
  };
  // Parameters are computed in the order of their declarations, and before the state.
  for (const Parameter& parameter : model.parameters) {
    add(parameter.name, parameter.values);
    for (const Setting& setting : settings) {
      if (setting.name == parameter.name) add(setting.name, setting.values);
    }
  }
  for (const Setting& setting : settings) add(setting.name, setting.values);
  if (chosen != model.scenes.end()) {
    if (chosen->h && !request.h) add("h", {chosen->h});
    if (chosen->steps && !request.steps && !request.time) add("steps", {chosen->steps});
  }
  std::vector<std::string> parameters = element_names(model.parameters);
  for (const Size& size : model.sizes) parameters.push_back(size.name);
  if (request.h) add("h", {read_expression("--h", *request.h, parameters)});
  if (request.steps) add("steps", {read_expression("--steps", *request.steps, parameters)});
  if (request.time) {
    add("steps", {read_expression("--time", *request.time, parameters)});
    if (found.contains("h")) found.insert("steps");
  }
  return found;
}

}  // namespace hamgen
