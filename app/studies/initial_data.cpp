#include "app/studies/initial_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/studies/domain.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/schemes/read_gauge.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {

Rational value_at_start(const StateMap::Sum& sum, const SceneValues& scene) {
  Rational total = 0;
  const auto n = static_cast<int>(scene.q.size());
  for (const auto& [i, factor] : sum.at_start)
    total += factor * (i < n ? scene.q[static_cast<std::size_t>(i)]
                             : scene.p[static_cast<std::size_t>(i - n)]);
  return total;
}

namespace {

// A folded parameter has the model's default in the code, whatever the scene or --set says.
void require_folded_defaults(const Model& model, const SceneValues& scene) {
  Model without_scenes = model;
  without_scenes.scenes.clear();
  const std::vector<Rational> defaults = scene_values(without_scenes, {}).parameters;
  std::size_t first = 0;
  for (const Parameter& parameter : model.parameters) {
    const std::size_t end = first + parameter.values.size();
    for (std::size_t i = first; i < end; ++i) {
      if (!parameter.folded || scene.parameters[i] == defaults[i]) continue;
      throw UsageError(
          fmt::format("--fold {0}: its default {1} is burnt in, but this run sets it to {2}\n"
                      "help: leave out --fold {0}, or change the default in {3}",
                      parameter.name, runtime::number_text(to_double(defaults[i])),
                      runtime::number_text(to_double(scene.parameters[i])), model.source.path));
    }
    first = end;
  }
}

// Near a pole of C an error is multiplied by 1/(h w - 2 pi k): by 100 at most, then.
void require_regular_step(const PluginSource& plugin, const Rational& step) {
  constexpr double nearest = 0.01 / (2 * std::numbers::pi);
  const double h = std::abs(to_double(step));
  for (const double pole : plugin.singular_steps) {
    const double k = std::round(h / pole);
    if (k < 1 || std::abs(h / pole - k) >= nearest) continue;
    throw UsageError(fmt::format(
        "--h {}: the gauge has a pole at h = {:.10g}, where h w = {:.0f}*2 pi for the frequency "
        "w = {:.10g} of the linear part\nhelp: take another step, for example --h {:.3g}",
        runtime::number_text(to_double(step)), k * pole, k, 2 * std::numbers::pi / pole,
        (k - 0.5) * pole));
  }
}

std::string state_text(const std::vector<std::string>& names, const std::vector<double>& state) {
  constexpr std::size_t largest = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(state.size(), largest); ++i)
    text += fmt::format("{}{} = {}", i == 0 ? "" : ", ", names[i], runtime::number_text(state[i]));
  return state.size() > largest ? text + ", ..." : text;
}

// "dH/dq[2] is not a number".  The sign of a nan means nothing.
std::string not_finite_text(const std::string& name, double value) {
  return name + (std::isnan(value) ? " is not a number" : " is infinite");
}

// Which value is not finite, empty if H and its gradient are finite.
std::string undefined_component(const runtime::Library& library,
                                const std::vector<std::string>& names,
                                const std::vector<double>& parameters,
                                const std::vector<double>& state) {
  const double energy = library.energy(parameters, state);
  if (!std::isfinite(energy)) return not_finite_text("H", energy);
  const std::vector<double> gradient = library.gradient(parameters, state);
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    if (!std::isfinite(gradient[i])) return not_finite_text("dH/d" + names[i], gradient[i]);
  }
  return "";
}

// What a parameter of the step is in the scene: one of the model, an array of equal entries, or a
// momentum that does not change.
Rational parameter_of(const std::string& name, const PluginSource& plugin,
                      const SceneValues& scene) {
  const std::vector<std::string> names = element_names(plugin.model.parameters);
  const auto is_it = [&name](const std::string& each) {
    return each == name || each.starts_with(name + "[");
  };
  if (const auto found = std::ranges::find_if(names, is_it); found != names.end())
    return scene.parameters[static_cast<std::size_t>(found - names.begin())];
  const auto constant = plugin.state.constants.find(name);
  if (constant == plugin.state.constants.end())
    internal_error("a plugin parameter the model does not have");
  return value_at_start(constant->second, scene);
}

void require_defined(const PluginSource& plugin, const SceneValues& scene,
                     const runtime::Library& library, const runtime::InitialValues& values) {
  const Model& model = plugin.model;
  const std::vector<std::string>& names = plugin.state.step_names;
  const std::vector<double> state = rounded(values.state);
  const std::string component =
      undefined_component(library, names, rounded(values.parameters), state);
  if (component.empty()) return;
  const std::string where = scene.name.empty() ? "" : fmt::format(" of scene '{}'", scene.name);
  throw ModelError(
      {{.severity = Severity::error,
        .span = model.hamiltonian->span,
        .message = fmt::format("H is not defined at the initial state{}: {}", where, component),
        .help = fmt::format("the initial state is {}; give another with --initial",
                            state_text(names, state))}},
      model.source);
}

}  // namespace

namespace {

__float128 quad_number(const runtime::Wide& value) {
  return static_cast<__float128>(value.hi) + static_cast<__float128>(value.lo);
}

// sum of factor * value, to 113 digits.
template <class Value>
runtime::Wide wide_sum(const std::map<int, Rational>& factors, const runtime::Wide& constant,
                       const Value& value) {
  const bool is_one = factors.size() == 1 && constant.hi == 0.0;
  if (is_one && abs(factors.begin()->second) == 1) {
    const runtime::Wide same = value(factors.begin()->first);
    return factors.begin()->second == 1 ? same
                                        : runtime::Wide{.hi = 0.0 - same.hi, .lo = 0.0 - same.lo};
  }
  __float128 sum = quad_number(constant);
  for (const auto& [place, factor] : factors)
    sum += quad_number(value(place)) * static_cast<__float128>(factor.get_num().get_d()) /
           static_cast<__float128>(factor.get_den().get_d());
  runtime::Wide result{.hi = static_cast<double>(sum)};
  result.lo = static_cast<double>(sum - static_cast<__float128>(result.hi));
  return result;
}

}  // namespace

bool watches_energy(const PluginSource& plugin, const SceneValues& scene) {
  if (!plugin.whole_energy) return false;
  return !observes_parts(plugin.model, scene) || observes(scene, "energy");
}

std::vector<runtime::Wide> whole_state(const PluginSource& plugin, const SceneValues& scene,
                                       const std::vector<runtime::Wide>& state) {
  const bool is_wide = std::ranges::any_of(state, [](const auto& x) { return x.lo != 0.0; });
  std::vector<runtime::Wide> whole;
  for (const StateMap::Sum& sum : plugin.state.model) {
    if (!sum.known) {
      whole.push_back({.hi = std::numeric_limits<double>::quiet_NaN()});
      continue;
    }
    whole.push_back(wide_sum(sum.of, wide(value_at_start(sum, scene)),
                             [&](int place) { return state[static_cast<std::size_t>(place)]; }));
    if (!is_wide) whole.back().lo = 0.0;
  }
  return whole;
}

std::vector<runtime::Wide> known_state(const PluginSource& plugin,
                                       const std::vector<runtime::Wide>& whole) {
  std::vector<runtime::Wide> state;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (plugin.state.model[i].known) state.push_back(whole[i]);
  }
  return state;
}

std::vector<runtime::Wide> kept_state(const PluginSource& plugin,
                                      const std::vector<runtime::Wide>& whole) {
  std::vector<runtime::Wide> state;
  for (const StateMap::Sum& sum : plugin.state.step)
    state.push_back(wide_sum(sum.at_start, {},
                             [&](int place) { return whole[static_cast<std::size_t>(place)]; }));
  return state;
}

runtime::Wide wide(const Rational& value) {
  const TripleDouble parts = to_triple(value);
  return {.hi = parts.hi, .lo = parts.lo};
}

std::vector<double> rounded(const std::vector<runtime::Wide>& values) {
  std::vector<double> result(values.size());
  std::ranges::transform(values, result.begin(), &runtime::Wide::hi);
  return result;
}

SceneValues complete_scene(const Model& model, const SceneRequest& request, const char* length) {
  const std::string& path = model.source.path;
  if (model.scenes.empty() && request.initial.empty() && degrees_of_freedom(model) > 0)
    throw UsageError(
        fmt::format("{} has no scene and no --initial is given: no initial state\n"
                    "help: for example --initial {}=0.1,{}=0 --h 0.01{}{}",
                    path, element_names(model.coordinates).front(),
                    element_names(model.momenta).front(), *length == 0 ? "" : " ", length));
  SceneValues values = scene_values(model, request);
  const std::string where = values.name.empty() ? path : fmt::format("scene '{}'", values.name);
  if (!values.h)
    throw UsageError(
        fmt::format("{} has no step size\nhelp: give one, for example --h 0.01", where));
  if (!values.steps)
    throw UsageError(
        fmt::format("{} does not say how long\nhelp: give it, for example {}", where, length));
  return values;
}

void require_in_range(const Model& model, const SceneValues& scene, const ScalarType& scalar) {
  const auto require = [&](const std::string& name, const Rational& value) {
    if (is_in_range(value, scalar)) return;
    const std::string where = scene.name.empty() ? "" : fmt::format(" of scene '{}'", scene.name);
    throw UsageError(fmt::format("{}{} is {}\nhelp: {}", name, where,
                                 out_of_range_message(value, scalar),
                                 out_of_range_help(value, scalar)));
  };
  const auto require_all = [&](const std::vector<std::string>& names,
                               const std::vector<Rational>& values) {
    for (std::size_t i = 0; i < names.size(); ++i) require(names[i], values[i]);
  };
  if (scene.h) require("h", *scene.h);
  require_all(element_names(model.parameters), scene.parameters);
  require_all(element_names(model.coordinates), scene.q);
  require_all(element_names(model.momenta), scene.p);
}

void take_gauge_at(const SceneValues& scene, const Model& model, Request& request) {
  if (!request.gauge->locally_exact) return;
  const Values origin = read_reference(model, {});
  const auto is_given = [&](const std::string& name) {
    return std::ranges::any_of(request.reference, [&](const auto& given) {
      return given.first == name || given.first == name.substr(0, name.find('['));
    });
  };
  std::vector<std::pair<std::string, std::string>> more;
  const auto add = [&](const std::vector<std::string>& names, const std::vector<Rational>& values) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (is_given(names[i]) || values[i] == origin.at(names[i])) continue;
      const std::string exact = hamgen::to_text(values[i]);
      const bool is_short = exact.size() <= 12;
      more.emplace_back(names[i], is_short ? exact : runtime::number_text(to_double(values[i])));
    }
  };
  add(element_names(model.parameters), scene.parameters);
  const bool has_point = std::ranges::any_of(request.reference, [&](const auto& given) {
    const std::string base = given.first.substr(0, given.first.find('['));
    return std::ranges::find(model.parameters, base, &Parameter::name) == model.parameters.end();
  });
  if (!has_point) {
    add(element_names(model.coordinates), scene.q);
    add(element_names(model.momenta), scene.p);
  }
  request.reference.insert(request.reference.end(), more.begin(), more.end());
}

runtime::InitialValues values_in_order(const PluginSource& plugin, const SceneValues& scene,
                                       const runtime::Library& library) {
  const Model& model = plugin.model;
  if (!plugin.for_scene) require_folded_defaults(model, scene);
  const auto scalar =
      std::ranges::find(all_scalars(), library.plugin().scalar_digits, &ScalarType::digits);
  require_in_range(model, scene, *scalar);
  require_regular_step(plugin, *scene.h);
  const std::size_t energy_parameters = plugin.needs_energy_parameter ? 1 : 0;
  runtime::InitialValues values;
  values.defined_everywhere = is_defined_everywhere(model);
  values.h = wide(*scene.h);
  for (const StateMap::Sum& sum : plugin.state.step)
    values.state.push_back(wide(value_at_start(sum, scene)));
  for (std::size_t i = 0; i + energy_parameters < plugin.parameter_names.size(); ++i)
    values.parameters.push_back(wide(parameter_of(plugin.parameter_names[i], plugin, scene)));
  if (plugin.needs_energy_parameter) values.parameters.push_back({});  // H does not depend on E0
  return values;
}

runtime::InitialValues initial_values(const PluginSource& plugin, const SceneValues& scene,
                                      const runtime::Library& library) {
  runtime::InitialValues values = values_in_order(plugin, scene, library);
  require_defined(plugin, scene, library, values);
  if (!plugin.needs_energy_parameter) return values;
  values.parameters.back() = library.energy(values.parameters, values.state);
  return values;
}

std::vector<std::pair<std::string, double>> parameter_values(const PluginSource& plugin,
                                                             const SceneValues& scene,
                                                             const runtime::InitialValues& start) {
  std::vector<std::pair<std::string, double>> values;
  std::size_t i = 0;
  for (const Parameter& parameter : plugin.model.parameters) {
    for (const std::string& name : element_names(std::vector{parameter})) {
      const double value = to_double(scene.parameters[i++]);
      if (!parameter.folded) values.emplace_back(name, value);
    }
  }
  if (plugin.needs_energy_parameter) values.emplace_back("E0", start.parameters.back().hi);
  return values;
}

}  // namespace hamgen::app
