#include "generator/read_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "generator/schemes/read_gauge.hpp"

namespace hamgen {

namespace {

// What alpha, beta and gamma are made of.
std::set<std::string> names_of_member(const Request& request) {
  std::set<std::string> names = request.alpha->names();
  names.merge(request.beta->names());
  names.merge(request.gamma->names());
  return names;
}

// alpha, beta and gamma may stand for themselves: then they are run-time parameters of the
// integrator, and `--beta beta --set beta=0.1` needs no compilation for another value.
void add_scheme_parameters(Model& model, const Request& request) {
  const std::set<std::string> used = names_of_member(request);
  std::set<std::string> known;
  for (const Variable& variable : model.coordinates) known.insert(variable.name);
  for (const Variable& variable : model.momenta) known.insert(variable.name);
  for (const Parameter& parameter : model.parameters) known.insert(parameter.name);
  for (const Size& size : model.sizes) known.insert(size.name);
  for (const Definition& definition : model.definitions) known.insert(definition.name);
  const std::pair<const char*, Rational> names[] = {
      {"alpha", Rational(1, 2)}, {"beta", Rational(0)}, {"gamma", Rational(0)}};
  for (const auto& [name, value] : names) {
    if (!used.contains(name) || known.contains(name)) continue;
    const Span nowhere{};
    model.parameters.push_back(
        {.name = name,
         .values = {std::make_shared<const Node>(Node{nowhere, NumberNode{value}})},
         .comment = "of the scheme"});
  }
  for (const std::string& name : request.scheme_parameters) {
    model.parameters.push_back(
        {.name = name,
         .values = {std::make_shared<const Node>(Node{Span{}, NumberNode{Rational(0)}})},
         .comment = "of the scheme"});
  }
}

// Burns the defaults of --fold in.
void fold_parameters(Model& model, const Request& request) {
  for (const std::string& name : request.fold) {
    const auto it = std::ranges::find(model.parameters, name, &Parameter::name);
    if (it == model.parameters.end()) {
      std::vector<std::string> names;
      for (const Parameter& parameter : model.parameters) names.push_back(parameter.name);
      if (const std::size_t equals = name.find('='); equals != std::string::npos)
        throw UsageError(
            fmt::format("--fold {}: a name is wanted, without a value\nhelp: --fold {} "
                        "burns the parameter's default in",
                        name, name.substr(0, equals)));
      const std::string near = nearest(name, names);
      throw UsageError(fmt::format("--fold {}: the model has no such parameter{}", name,
                                   near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
    it->folded = true;
  }
}

// Names of the model that the scheme's options use: they have to keep their meaning there.
std::set<std::string> named_by_scheme(const Model& model, const Request& request) {
  std::set<std::string> used = names_of_member(request);
  if (request.gauge->matrix) used.merge(request.gauge->matrix->names());
  std::set<std::string> names;
  for (const Parameter& parameter : model.parameters) {
    if (used.contains(parameter.name)) names.insert(parameter.name);
  }
  if (!request.gauge->locally_exact) return names;
  // It is exact with the parameters of its reference.
  const Values reference = read_reference(model, request.reference);
  const std::vector<std::string> elements = element_names(model.parameters);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const bool is_element = elements[i].find('[') != std::string::npos;
    if (is_element || reference.at(elements[i]) != request.scene->values.parameters[i])
      names.insert(elements[i]);
  }
  return names;
}

// Their values are computed beside the invariants.
void add_events(Model& model) {
  if (model.events.empty()) throw UsageError("--events: " + no_event_text(model));
  for (const ModelEvent& each : model.events) {
    model.invariants.push_back({.name = each.name,
                                .value = each.value,
                                .text = each.formula,
                                .comment = each.comment,
                                .span = each.span,
                                .only_observed = true,
                                .rising = each.rising,
                                .falling = each.falling});
  }
}

}  // namespace

Model read_request(const SourceText& source, const Request& request) {
  Model model = read_model(source, request.sizes);
  for (Size& size : model.sizes) {
    const auto other = request.numbers_of_sizes.find(size.name);
    if (other != request.numbers_of_sizes.end()) size.number = other->second;
  }
  add_scheme_parameters(model, request);
  fold_parameters(model, request);
  if (request.events) add_events(model);
  return model;
}

// Defaults of parameters are literals of the emitted code.
void require_defaults_in_range(const Model& model, const ScalarType& scalar) {
  const std::vector<Rational> defaults = default_parameters(model);
  std::vector<Diagnostic> mistakes;
  std::size_t i = 0;
  for (const Parameter& parameter : model.parameters) {
    for (const NodePtr& node : parameter.values) {
      const Rational& value = defaults.at(i++);
      if (is_in_range(value, scalar)) continue;
      mistakes.push_back({.span = node->span,
                          .message = fmt::format("the default of '{}' is {}", parameter.name,
                                                 out_of_range_message(value, scalar)),
                          .help = out_of_range_help(value, scalar)});
    }
  }
  if (!mistakes.empty()) throw ModelError(std::move(mistakes), model.source);
}

std::optional<SceneFacts> scene_facts(const Model& model, const Request& request) {
  if (!request.scene) return {};
  SceneFacts scene = *request.scene;
  const std::vector<std::string> names = element_names(model.parameters);
  for (std::size_t i = 0; i < std::min(names.size(), scene.values.parameters.size()); ++i)
    scene.parameters.emplace(names[i], scene.values.parameters[i]);
  scene.kept.merge(named_by_scheme(model, request));
  if (request.watch_modified > 0) {
    scene.values.observe.clear();
    scene.values.formulas.clear();
  }
  return scene;
}

FoldedModel fold_for_scene(const Model& model, const Request& request) {
  const std::optional<SceneFacts> scene = scene_facts(model, request);
  if (!scene) return {model, {}};
  return fold(observed(model, scene->values), *scene, request.fold);
}

// Loops know one set of parameters for all degrees of freedom.
bool may_keep_sums(const Request& request) {
  return request.gauge.empty() && !request.observe_curvature && request.alpha->is_uniform() &&
         request.beta->is_uniform() && request.gamma->is_uniform();
}

}  // namespace hamgen
