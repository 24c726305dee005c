#include "app/output/model_json.hpp"

namespace hamgen::app {
namespace {

using Json = nlohmann::ordered_json;

// With a range if it is an array, a unit and a comment if there is one.
template <class Declared>
Json declared(const Declared& each) {
  Json row = {{"name", each.name}};
  if (each.range) row["range"] = {each.range->first, each.range->last};
  if (!each.unit.empty()) row["unit"] = each.unit;
  if (!each.comment.empty()) row["comment"] = each.comment;
  return row;
}

Json texts_of(const std::vector<NodePtr>& values) {
  Json texts = Json::array();
  for (const NodePtr& value : values) texts.push_back(to_text(value));
  return texts;
}

Json scene_json(const Scene& scene) {
  Json row = {{"name", scene.name}};
  if (!scene.comment.empty()) row["comment"] = scene.comment;
  Json settings = Json::array();
  for (const hamgen::Setting& setting : scene.settings) {
    Json one = {{"name", setting.name}};
    if (setting.element) one["element"] = to_text(setting.element);
    if (!setting.index.empty()) one["index"] = setting.index;
    if (setting.is_list) {
      one["values"] = texts_of(setting.values);
    } else {
      one["value"] = to_text(setting.values.front());
    }
    settings.push_back(std::move(one));
  }
  row["settings"] = std::move(settings);
  if (scene.h) row["h"] = to_text(scene.h);
  if (scene.steps) row["steps"] = to_text(scene.steps);
  if (scene.every) row["every"] = to_text(scene.every);
  return row;
}

template <class List, class Function>
Json list_of(const List& list, Function function) {
  Json rows = Json::array();
  for (const auto& each : list) rows.push_back(function(each));
  return rows;
}

}  // namespace

Json model_json(const Model& model) {
  const auto formula = [](const auto& each) {
    return Json{{"name", each.name}, {"value", each.text}};
  };
  return {{"system", model.name},
          {"H", model.hamiltonian_text},
          {"sizes", list_of(model.sizes,
                            [](const Size& size) {
                              return Json{{"name", size.name}, {"value", size.value}};
                            })},
          {"coordinates", list_of(model.coordinates, declared<Variable>)},
          {"momenta", list_of(model.momenta, declared<Variable>)},
          {"parameters", list_of(model.parameters,
                                 [](const Parameter& each) {
                                   Json row = declared(each);
                                   row["values"] = texts_of(each.values);
                                   return row;
                                 })},
          {"invariants", list_of(model.invariants, formula)},
          {"events", list_of(model.events, formula)},
          {"scenes", list_of(model.scenes, scene_json)}};
}

}  // namespace hamgen::app
