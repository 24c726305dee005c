#include "app/studies/stress_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "app/studies/initial_data.hpp"
#include "app/studies/load_integrator.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/language/read_model.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

constexpr long kMostCells = 100'000;

double constant_of(const std::string& option, const std::string& text) {
  const std::string what = option + " " + text;
  return to_double(evaluate_constant(read_expression(what, text, {}), make_source(what, text), {}));
}

// "k=1:1e6:7" or "h=1e-4:1e3"; h counts in units of the scene's.
StressAxis axis_of(const std::string& text) {
  const auto [name, range] = split_assignment("--vary", text);
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= range.size();) {
    const std::size_t end = std::min(range.find(':', begin), range.size());
    parts.push_back(range.substr(begin, end - begin));
    begin = end + 1;
  }
  const std::string option = "--vary " + text;
  if (parts.size() < 2 || parts.size() > 3)
    throw UsageError(
        fmt::format("{}: not a range\nhelp: write --vary {}=LOW:HIGH or "
                    "--vary {}=LOW:HIGH:COUNT",
                    option, name, name));
  const double low = constant_of(option, parts[0]);
  const double high = constant_of(option, parts[1]);
  if (!(low < high)) throw UsageError(fmt::format("{}: the range is empty", option));
  if (name == "h" && !(low > 0.0))
    throw UsageError(fmt::format("{}: a step is more than 0 times the scene's", option));
  StressAxis axis{.label = name, .logarithmic = low > 0.0 && high / low >= 20.0};
  const double span = axis.logarithmic ? std::log10(high / low) : high - low;
  const long count = parts.size() == 3  ? integer_value(option, parts[2], 2)
                     : axis.logarithmic ? std::lround(4.0 * span) + 1
                                        : 21;
  if (count > 1000) throw UsageError(fmt::format("{}: more than 1000 values", option));
  for (long i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    axis.values.push_back(i == 0             ? low
                          : i + 1 == count   ? high
                          : axis.logarithmic ? low * std::pow(10.0, part * span)
                                             : low + part * span);
  }
  return axis;
}

std::vector<StressAxis> axes_of(const StressOptions& options) {
  std::vector<StressAxis> axes;
  for (const std::string& text : options.vary) axes.push_back(axis_of(text));
  const bool has_h = std::ranges::any_of(axes, [](const auto& axis) { return axis.label == "h"; });
  if (axes.size() < 2 && !has_h) axes.insert(axes.begin(), axis_of("h=1e-4:1e3"));
  if (axes.size() > 2)
    throw UsageError("--vary: a map has two axes\nhelp: fix the others with --set, --h, --beta");
  if (axes.size() == 2 && axes[0].label == axes[1].label)
    throw UsageError(fmt::format("--vary {}: given twice", axes[0].label));
  const auto cells =
      static_cast<long>(axes[0].values.size() * (axes.size() > 1 ? axes[1].values.size() : 1));
  if (cells > kMostCells)
    throw UsageError(fmt::format("--vary: {} cells; at most {} can be run", cells, kMostCells));
  return axes;
}

bool mentions_word(const std::string& text, const std::string& word) {
  const auto is_letter = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += word.size()) {
    const bool begins = at == 0 || !is_letter(text[at - 1]);
    const std::size_t end = at + word.size();
    if (begins && (end == text.size() || !is_letter(text[end]))) return true;
  }
  return false;
}

// The axis alpha varies --alpha itself, if no expression mentions it.
MethodOptions with_run_time_members(MethodOptions method, const std::vector<StressAxis>& axes) {
  const std::string texts = method.alpha + "," + method.beta + "," + method.gamma;
  for (const auto& [name, value] :
       {std::pair{"alpha", &method.alpha}, std::pair{"beta", &method.beta},
        std::pair{"gamma", &method.gamma}}) {
    const bool varied = std::ranges::any_of(
        axes, [name = std::string(name)](const auto& axis) { return axis.label == name; });
    if (!varied || mentions_word(texts, name)) continue;
    if (!value->empty())
      throw UsageError(
          fmt::format("--vary {0} and --{0} {1}: both choose {0}\nhelp: leave one out, "
                      "or use {0} in the expression",
                      name, *value));
    *value = name;
  }
  return method;
}

// alpha, beta or gamma as one number; empty for a list or an expression in E0.
std::optional<double> member_number(const std::string& text, double fallback,
                                    const std::vector<std::string>& names,
                                    const std::map<std::string, Rational>& values) {
  if (text.empty()) return fallback;
  try {
    return to_double(evaluate_constant(read_expression("member", text, names),
                                       make_source("member", text), values));
  } catch (const ModelError&) {
    return std::nullopt;
  }
}

}  // namespace

StressGrid::StressGrid(const StressOptions& options) : options_(options), axes_(axes_of(options)) {
  options_.method = with_run_time_members(options.method, axes_);
  const SourceText source = read_model_source(options_.method);
  Request request = request_of(options_.method);
  set_ = split_sizes(read_model(source), options_.scene.set);
  request.sizes = set_.sizes;
  if (request.gauge == "locally-exact") {
    const Model model = read_request(source, request);
    SceneRequest base = scene_request(options_.scene, set_.rest);
    base.h = options_.h;
    base.steps = options_.steps;
    take_gauge_at(complete_scene(model, base), model, request);
  }
  plugin_ = generate_plugin(source, request);
  const std::vector<std::string> known = element_names(plugin_.model.parameters);
  for (const StressAxis& axis : axes_) {
    if (axis.label == "h" || axis.label == "scale") continue;
    if (std::ranges::find(known, axis.label) != known.end()) continue;
    const std::string near = nearest(axis.label, known);
    throw UsageError(fmt::format(
        "--vary {}: no parameter of {}{}\nhelp: besides parameters there are h, scale (of the "
        "initial state), alpha, beta and gamma",
        axis.label, options.method.model, near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  loaded_ = load_integrator(plugin_, "");
  const std::vector<Scene>& scenes = plugin_.model.scenes;
  scene_name_ = !options_.scene.scene.empty() ? options_.scene.scene
                : scenes.empty()              ? ""
                                              : scenes.front().name;
}

SceneValues StressGrid::scene_at(const std::vector<double>& at) const {
  SceneRequest request = scene_request(options_.scene, set_.rest);
  request.h = options_.h;
  request.steps = options_.steps;
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
  std::optional<runtime::InitialValues> start;
  try {
    start = start_at(at);
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
  const MethodOptions& method = options_.method;
  double alpha = 0.5;
  if (method.scheme == "symplectic-euler-a") alpha = 0.0;
  if (method.scheme == "symplectic-euler-b") alpha = 1.0;
  const bool is_member =
      method.scheme.empty() || alpha != 0.5 || method.scheme == "implicit-midpoint";
  if (!is_member) return std::nullopt;
  const SceneValues scene = scene_at(at);
  std::vector<std::string> names = element_names(plugin_.model.parameters);
  std::map<std::string, Rational> values;
  for (std::size_t i = 0; i < names.size(); ++i) values[names[i]] = scene.parameters[i];
  names.push_back("h");
  values["h"] = *scene.h;
  const auto a = member_number(method.alpha, alpha, names, values);
  const auto b = member_number(method.beta, 0.0, names, values);
  const auto c = member_number(method.gamma, 0.0, names, values);
  if (!a || !b || !c) return std::nullopt;
  const double h = start->h.hi;
  return Linear{.h_omega = std::fabs(h) * std::sqrt(*found->second),
                .margin = linear_margin(h, *found->second, *a, *b, *c)};
}

std::vector<std::array<double, 2>> StressGrid::linear_bound() {
  if (axes_.size() < 2) return {};
  const MethodOptions& chosen = options_.method;
  const bool is_midpoint = (chosen.scheme.empty() || chosen.scheme == "implicit-midpoint") &&
                           (chosen.alpha + chosen.beta + chosen.gamma).empty();
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
  const auto search = [&](bool along_y, double fixed, double from, double to) {
    const auto at = [&](double t) { return along_y ? margin(fixed, t) : margin(t, fixed); };
    const auto left = at(from);
    const auto right = at(to);
    if (!left || !right || (*left > 0.0) == (*right > 0.0)) return;
    for (int halving = 0; halving < 12; ++halving) {
      const double middle = 0.5 * (from + to);
      const auto there = at(middle);
      if (!there) return;
      ((*there > 0.0) == (*left > 0.0) ? from : to) = middle;
    }
    points.push_back(
        {value(axes_[0], along_y ? fixed : from), value(axes_[1], along_y ? from : fixed)});
  };
  for (int i = 0; i <= across; ++i) {
    for (int j = 0; j < up; ++j)
      search(true, static_cast<double>(i) / across, static_cast<double>(j) / up,
             static_cast<double>(j + 1) / up);
  }
  for (int j = 0; j <= across; ++j) {
    for (int i = 0; i < up; ++i)
      search(false, static_cast<double>(j) / across, static_cast<double>(i) / up,
             static_cast<double>(i + 1) / up);
  }
  return points;
}

}  // namespace hamgen::app
