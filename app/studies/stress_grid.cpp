#include "app/studies/stress_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

// alpha, beta or gamma as one number; empty for a list or an expression in E0.
std::optional<double> member_number(const GaugeFormula& formula,
                                    const std::vector<std::string>& names,
                                    const std::map<std::string, Rational>& values) {
  if (!formula.is_uniform()) return std::nullopt;
  const auto& [text, node] = formula.rows[0][0];
  try {
    require_names(node, "member", text, names);
    return to_double(evaluate_constant(node, make_source("member", text), values));
  } catch (const ModelError&) {
    return std::nullopt;
  }
}

}  // namespace

StressGrid::StressGrid(const StressRequest& asked) : setting_(asked.setting), axes_(asked.axes) {
  if (setting_.request.gauge->locally_exact)
    take_gauge_at(complete_scene(setting_.model, setting_.scene), setting_.model, setting_.request);
  plugin_ = generate_plugin(setting_.source, setting_.request);
  const std::vector<std::string> known = element_names(plugin_.model.parameters);
  for (const StressAxis& axis : axes_) {
    if (axis.label == "h" || axis.label == "scale") continue;
    if (std::ranges::find(known, axis.label) != known.end()) continue;
    const std::string near = nearest(axis.label, known);
    throw UsageError(fmt::format(
        "--vary {}: no parameter of {}{}\nhelp: besides parameters there are h, scale (of the "
        "initial state), alpha, beta and gamma",
        axis.label, setting_.source.path, near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  double steps = static_cast<double>(asked.limits.steps);
  for (const StressAxis& axis : axes_) steps *= static_cast<double>(axis.values.size());
  constexpr double of_bound = 1e6;  // which takes gradients at some ten thousand places
  if (asked.with_bound && axes_.size() == 2) steps += of_bound;
  loaded_ = load_integrator(plugin_, {}, asked.limits.stop, steps);
  const std::vector<Scene>& scenes = plugin_.model.scenes;
  scene_name_ = !setting_.scene.scene.empty() ? setting_.scene.scene
                : scenes.empty()              ? ""
                                              : scenes.front().name;
}

SceneValues StressGrid::scene_at(const std::vector<double>& at) const {
  SceneRequest request = setting_.scene;
  double factor = 1.0;
  double scale = 1.0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].label == "h") {
      factor = at[i];
    } else if (axes_[i].label == "scale") {
      scale = at[i];
    } else {
      request.set.emplace_back(axes_[i].label, runtime::number_text(at[i]));
    }
  }
  SceneValues scene = complete_scene(plugin_.model, request);
  scene.h = from_double(to_double(*scene.h) * factor);
  for (std::vector<Rational>* half : {&scene.q, &scene.p}) {
    for (Rational& value : *half) value *= from_double(scale);
  }
  return scene;
}

runtime::InitialValues StressGrid::start_at(const std::vector<double>& at) const {
  return initial_values(plugin_, scene_at(at), *loaded_.library);
}

std::optional<StressGrid::Linear> StressGrid::linear_at(const std::vector<double>& at) {
  SceneValues scene;
  std::optional<runtime::InitialValues> start;
  try {
    scene = scene_at(at);
    start = initial_values(plugin_, scene, *loaded_.library);
  } catch (const ModelError&) {
    return std::nullopt;
  } catch (const UsageError&) {
    return std::nullopt;
  }
  std::vector<double> place;  // what omega depends on
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const std::string& name = axes_[i].label;
    const bool of_the_step = name == "h" || name == "alpha" || name == "beta" || name == "gamma";
    place.push_back(of_the_step ? 0.0 : at[i]);
  }
  auto found = omega_squared_.find(place);
  if (found == omega_squared_.end()) {
    found = omega_squared_
                .emplace(place, fastest_oscillation(*loaded_.library, rounded(start->parameters),
                                                    rounded(start->state)))
                .first;
  }
  if (!found->second) return std::nullopt;
  const Request& method = setting_.request;
  double alpha = 0.5;
  if (method.scheme == "symplectic-euler-a") alpha = 0.0;
  if (method.scheme == "symplectic-euler-b") alpha = 1.0;
  const bool is_member =
      method.scheme.empty() || alpha != 0.5 || method.scheme == "implicit-midpoint";
  if (!is_member) return std::nullopt;
  std::vector<std::string> names = element_names(plugin_.model.parameters);
  std::map<std::string, Rational> values;
  for (std::size_t i = 0; i < names.size(); ++i) values[names[i]] = scene.parameters[i];
  names.push_back("h");
  values["h"] = *scene.h;
  const auto a = method.alpha.empty() ? alpha : member_number(*method.alpha, names, values);
  const auto b = member_number(*method.beta, names, values);
  const auto c = member_number(*method.gamma, names, values);
  if (!a || !b || !c) return std::nullopt;
  const double h = start->h.hi;
  return Linear{.h_omega = std::fabs(h) * std::sqrt(*found->second),
                .margin = linear_margin(h, *found->second, *a, *b, *c)};
}

std::vector<std::array<double, 2>> StressGrid::linear_bound() {
  if (axes_.size() < 2) return {};
  const Request& chosen = setting_.request;
  const bool is_midpoint = (chosen.scheme.empty() || chosen.scheme == "implicit-midpoint") &&
                           chosen.alpha.empty() && chosen.beta.empty() && chosen.gamma.empty();
  if (is_midpoint) return {};  // bounded for every h omega
  constexpr int across = 160;
  constexpr int up = 80;
  const auto value = [](const StressAxis& axis, double part) {
    const double low = axis.values.front();
    const double high = axis.values.back();
    return axis.logarithmic ? low * std::pow(high / low, part) : low + part * (high - low);
  };
  const auto margin = [&](double x, double y) {
    const auto linear = linear_at({value(axes_[0], x), value(axes_[1], y)});
    return linear ? std::optional(linear->margin) : std::nullopt;
  };
  std::vector<std::array<double, 2>> points;
  const auto search = [&](bool along_y, double fixed) {
    const auto at = [&](double t) { return along_y ? margin(fixed, t) : margin(t, fixed); };
    // Between two values of t whose margins are of two signs.
    const auto between = [&](double from, double to, bool is_bounded_from) {
      for (int halving = 0; halving < 12; ++halving) {
        const double middle = 0.5 * (from + to);
        const auto there = at(middle);
        if (!there) return;
        ((*there > 0.0) == is_bounded_from ? from : to) = middle;
      }
      points.push_back(
          {value(axes_[0], along_y ? fixed : from), value(axes_[1], along_y ? from : fixed)});
    };
    auto left = at(0.0);
    for (int i = 0; i < up; ++i) {
      const double from = static_cast<double>(i) / up;
      const double to = static_cast<double>(i + 1) / up;
      const auto right = at(to);
      if (left && right && (*left > 0.0) != (*right > 0.0)) between(from, to, *left > 0.0);
      left = right;
    }
  };
  for (const bool along_y : {true, false}) {
    for (int i = 0; i <= across; ++i) search(along_y, static_cast<double>(i) / across);
  }
  return points;
}

}  // namespace hamgen::app
