#include "app/studies/varied_start.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "app/studies/initial_data.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

bool is_defined_at(const runtime::Library& library, const runtime::InitialValues& start) {
  const std::vector<double> parameters = rounded(start.parameters);
  const std::vector<double> state = rounded(start.state);
  return std::isfinite(library.energy(parameters, state)) &&
         std::ranges::all_of(library.gradient(parameters, state),
                             [](double x) { return std::isfinite(x); });
}

// Does the run compute anything else from the parameters among the names?  Of an element of an
// array nobody asks further.
bool computes_from(const Model& model, const SceneRequest& request,
                   const std::vector<std::string>& parameters) {
  for (const std::string& name : parameters) {
    if (name.find('[') != std::string::npos) return true;
  }
  return names_computed_from(model, request, parameters) !=
         std::set<std::string>(parameters.begin(), parameters.end());
}

}  // namespace

VariedStart::VariedStart(const PluginSource& plugin, const runtime::Library& library,
                         SceneRequest scene, std::vector<std::string> names)
    : plugin_(plugin), library_(library), request_(std::move(scene)), names_(std::move(names)) {
  std::vector<std::string> all = element_names(plugin.model.parameters);
  parameters_ = all.size();
  std::ranges::copy(element_names(plugin.model.coordinates), std::back_inserter(all));
  n_ = all.size() - parameters_;
  std::ranges::copy(element_names(plugin.model.momenta), std::back_inserter(all));
  std::vector<std::string> varied_parameters;
  for (const std::string& name : names_) {
    const auto found = std::ranges::find(all, name);
    if (found == all.end()) internal_error("a varied name the model does not have");
    rows_.push_back(static_cast<std::size_t>(found - all.begin()));
    if (rows_.back() < parameters_) varied_parameters.push_back(name);
  }
  direct_ = library.plugin().scalar_digits == 53 &&
            !computes_from(plugin.model, request_, varied_parameters);
  base_scene_ = complete_scene(plugin.model, request_);
  base_ = values_in_order(plugin, base_scene_, library);
  if (direct_) find_places();
}

// Values that a sum or another name of the step takes up are left to exact arithmetic.
void VariedStart::find_places() {
  const auto add = [&](const StateMap::Sum& sum, bool is_parameter, std::size_t at) {
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (rows_[k] < parameters_) continue;
      const auto found = sum.at_start.find(static_cast<int>(rows_[k] - parameters_));
      if (found == sum.at_start.end() || found->second == 0) continue;
      if (sum.at_start.size() > 1 || found->second != 1) direct_ = false;
      places_.push_back({.name = k, .is_parameter = is_parameter, .at = at});
    }
  };
  for (std::size_t i = 0; i < plugin_.state.step.size(); ++i) add(plugin_.state.step[i], false, i);
  const std::vector<std::string> model_parameters = element_names(plugin_.model.parameters);
  for (std::size_t i = 0; i < plugin_.parameter_names.size(); ++i) {
    const std::string& name = plugin_.parameter_names[i];
    if (const auto varied = std::ranges::find(names_, name); varied != names_.end()) {
      places_.push_back({.name = static_cast<std::size_t>(varied - names_.begin()),
                         .is_parameter = true,
                         .at = i});
    } else if (const auto constant = plugin_.state.constants.find(name);
               constant != plugin_.state.constants.end()) {
      add(constant->second, true, i);
    }
  }
}

SceneValues VariedStart::scene_with(std::span<const double> values) const {
  SceneRequest scene = request_;
  for (std::size_t k = 0; k < names_.size(); ++k)
    (rows_[k] < parameters_ ? scene.set : scene.initial)
        .emplace_back(names_[k], runtime::number_text(values[k]));
  return complete_scene(plugin_.model, scene);
}

std::optional<VariedStart::Start> VariedStart::computed(std::span<const double> values) const {
  try {
    Start start{.scene = scene_with(values), .values = {}};
    start.values = initial_values(plugin_, start.scene, library_);
    return start;
  } catch (const ModelError&) {
    return std::nullopt;
  } catch (const UsageError&) {
    return std::nullopt;
  }
}

std::optional<VariedStart::Start> VariedStart::at(std::span<const double> values) const {
  if (!std::ranges::all_of(values, [](double x) { return std::isfinite(x); })) return std::nullopt;
  if (!direct_) return computed(values);
  Start start{.scene = base_scene_, .values = base_};
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const std::size_t row = rows_[k];
    Rational& place = row < parameters_        ? start.scene.parameters[row]
                      : row < parameters_ + n_ ? start.scene.q[row - parameters_]
                                               : start.scene.p[row - parameters_ - n_];
    place = from_double(values[k]);
  }
  for (const Place& place : places_)
    (place.is_parameter ? start.values.parameters : start.values.state)[place.at] = {
        values[place.name], 0.0};
  if (!is_defined_at(library_, start.values)) return std::nullopt;
  if (plugin_.needs_energy_parameter)
    start.values.parameters.back() = library_.energy(start.values.parameters, start.values.state);
  return start;
}

}  // namespace hamgen::app
