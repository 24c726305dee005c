#include "app/output/report_orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/output/math_symbol.hpp"
#include "app/output/plain_number.hpp"
#include "app/studies/initial_data.hpp"

namespace hamgen::app {
namespace {

constexpr long kOrbitSteps = 20'000;  // of a picture
constexpr long kWaveSteps = 2'000;    // of coordinates over time
constexpr std::size_t kBodies = 8;    // colours

using OrbitStates = std::vector<std::vector<double>>;

struct DrawnOrbit {
  std::vector<double> times;
  OrbitStates states;  // of all degrees of freedom, after each step
};

// Up to a failure.
DrawnOrbit orbit_from(const BenchMethod& method, const SceneValues& scene,
                      const runtime::InitialValues& start, long steps) {
  DrawnOrbit orbit;
  runtime::Integrator integrator(method.loaded.library, start);
  runtime::IntegrateOptions options;
  options.steps = steps;
  options.every = 1;
  options.stop = method.stop;
  options.on_record = [&](const runtime::Record& record) {
    orbit.times.push_back(record.time);
    orbit.states.push_back(
        rounded(whole_state(method.plugin, scene, {record.state.begin(), record.state.end()})));
  };
  static_cast<void>(runtime::integrate(integrator, options));
  return orbit;
}

double extent(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax_element(values);
  return values.empty() ? 0.0 : *high - *low;
}

// Points nearer to the one before than can be seen are left out, and more where there are many.
PlotSeries thin_line(const std::vector<double>& x, const std::vector<double>& y,
                     const std::string& label, int colour) {
  constexpr std::size_t many = 4'000;
  PlotSeries series{.label = label, .points = {}, .style = PlotStyle::thin_lines, .colour = colour};
  for (double seen = 0.004; seen < 0.02; seen *= 1.5) {
    const double across = seen * extent(x);
    const double up = seen * extent(y);
    series.points.clear();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const bool is_end = i == 0 || i + 1 == x.size();
      if (is_end || std::fabs(x[i] - series.points.back().x) > across ||
          std::fabs(y[i] - series.points.back().y) > up)
        series.points.push_back({x[i], y[i]});
    }
    if (series.points.size() <= many) break;
  }
  return series;
}

std::vector<double> component(const OrbitStates& states, std::size_t i) {
  std::vector<double> values;
  for (const std::vector<double>& state : states) values.push_back(state[i]);
  return values;
}

// How many states a line shows before it only fills an area: its length in extents.
std::size_t states_of_line(const OrbitStates& states) {
  constexpr double longest = 90.0;
  if (states.empty()) return 0;
  const std::size_t n = states.front().size();
  std::vector<double> extents;
  for (std::size_t i = 0; i < n; ++i) extents.push_back(extent(component(states, i)));
  double length = 0.0;
  for (std::size_t k = 1; k < states.size(); ++k) {
    double square = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      if (extents[i] > 0.0) square += std::pow((states[k][i] - states[k - 1][i]) / extents[i], 2);
    }
    length += std::sqrt(square / static_cast<double>(n));
    if (length > longest) return k + 1;
  }
  return states.size();
}

// What the axes of a picture show: coordinates by name, each the place of its first body's value.
struct Space {
  std::vector<std::string> names;
  std::vector<std::size_t> places;
  std::size_t bodies = 1;
};

// Without a time, which is the last one and no place.
std::size_t coordinates_of(const Model& model) {
  const bool has_time = !model.coordinates.empty() && model.coordinates.back().is_time;
  return element_names(model.coordinates).size() - (has_time ? 1 : 0);
}

// Coordinates of a point, or of bodies where they are arrays over the same range.
Space space_of(const Model& model) {
  Space space;
  std::size_t place = 0;
  for (const Variable& each : model.coordinates) {
    if (each.is_time) continue;
    space.names.push_back(each.name);
    space.places.push_back(place);
    const auto count = each.range ? static_cast<std::size_t>(each.range->size()) : std::size_t{1};
    place += count;
    if (&each == &model.coordinates.front()) space.bodies = count;
    if (count != space.bodies) return {};
  }
  const std::size_t axes = space.names.size();
  return axes == 2 || axes == 3 ? space : Space{};
}

PlotPanel plane(const Space& space, const DrawnOrbit& orbit, std::size_t first,
                std::size_t second) {
  PlotPanel panel{.title = "",
                  .x_label = plain_symbol(space.names[first]),
                  .y_label = plain_symbol(space.names[second]),
                  .series = {}};
  for (std::size_t body = 0; body < std::min(space.bodies, kBodies); ++body)
    panel.series.push_back(thin_line(component(orbit.states, space.places[first] + body),
                                     component(orbit.states, space.places[second] + body),
                                     space.bodies > 1 ? std::to_string(body + 1) : "",
                                     static_cast<int>(body)));
  panel.square = suits_one_unit(panel);
  return panel;
}

Figure orbit_in_space(const Space& space, const DrawnOrbit& orbit, const std::string& what) {
  const std::string shown = space.bodies > kBodies ? fmt::format(" of the first {} bodies", kBodies)
                            : space.bodies > 1     ? fmt::format(" of the {} bodies", space.bodies)
                                                   : "";
  Figure figure{.name = "orbit",
                .caption = fmt::format("The orbit{}: {}.", shown, what),
                .plot = {.panels = {plane(space, orbit, 0, 1)}, .width = 440, .height = 370}};
  if (space.names.size() < 3) return figure;
  figure.plot.panels.push_back(plane(space, orbit, 0, 2));
  figure.plot.panels.push_back(plane(space, orbit, 1, 2));
  figure.plot.width = 360;
  figure.plot.height = 360;
  figure.large = true;
  figure.caption = fmt::format("The orbit{} from three sides: {}.", shown, what);
  return figure;
}

Figure coordinates_over_time(const Model& model, const DrawnOrbit& orbit, const std::string& what) {
  const std::vector<std::string> names = element_names(model.coordinates);
  const std::size_t all = coordinates_of(model);
  PlotPanel panel{.title = "", .x_label = "t", .y_label = "coordinates", .series = {}};
  const std::size_t count = std::min(all, kBodies);
  for (std::size_t i = 0; i < count; ++i)
    panel.series.push_back(thin_line(orbit.times, component(orbit.states, i),
                                     plain_symbol(names[i]), static_cast<int>(i)));
  const std::string shown = all > count ? fmt::format("The first {} of {} coordinates", count, all)
                                        : std::string("The coordinates");
  return {.name = "orbit",
          .caption = fmt::format("{} over time: {}.", shown, what),
          .plot = {.panels = {panel}, .width = 1000, .height = 420},
          .large = true};
}

Figure portrait(const BenchMethod& method, const SceneValues& scene, const DrawnOrbit& orbit,
                const std::string& what) {
  const Model& model = method.plugin.model;
  const std::size_t n = orbit.states.empty() ? 1 : orbit.states.front().size() / 2;
  PlotPanel phase{.title = "",
                  .x_label = plain_symbol(element_names(model.coordinates).front()),
                  .y_label = plain_symbol(element_names(model.momenta).front()),
                  .series = {}};
  std::string caption = fmt::format("Phase portrait: {}.", what);
  if (n == 1) {
    const runtime::InitialValues start =
        initial_values(method.plugin, scene, *method.loaded.library);
    for (const double factor : {0.25, 0.5, 0.75}) {
      runtime::InitialValues smaller = start;
      for (runtime::Wide& value : smaller.state) value = {.hi = factor * value.hi};
      const DrawnOrbit inner =
          orbit_from(method, scene, smaller, static_cast<long>(orbit.states.size()));
      phase.series.push_back(
          thin_line(component(inner.states, 0), component(inner.states, 1), "", 6));
    }
    caption += " In light blue orbits from 1/4, 1/2 and 3/4 of the initial state.";
  }
  phase.series.push_back(thin_line(component(orbit.states, 0), component(orbit.states, n), "", 0));
  return {.name = "portrait",
          .caption = caption,
          .plot = {.panels = {phase}, .width = 440, .height = 370}};
}

}  // namespace

std::vector<Figure> orbit_figures(const BenchMethod& method, const SceneValues& scene) {
  const Model& model = method.plugin.model;
  const Space space = space_of(model);
  const std::size_t count = coordinates_of(model);
  const bool is_wave = count > 1 && space.names.empty();
  const long steps = std::min(*scene.steps, is_wave ? kWaveSteps : kOrbitSteps);
  DrawnOrbit orbit = orbit_from(
      method, scene, initial_values(method.plugin, scene, *method.loaded.library), steps);
  if (!is_wave) orbit.states.resize(states_of_line(orbit.states));
  orbit.times.resize(orbit.states.size());
  const auto drawn = static_cast<long>(orbit.states.size()) - 1;
  const std::string what = drawn == *scene.steps
                               ? fmt::format("all {} steps", drawn)
                               : fmt::format("the first {} of {} steps", drawn, *scene.steps);
  std::vector<Figure> figures;
  if (is_wave) {
    figures.push_back(coordinates_over_time(model, orbit, what));
  } else if (count > 1) {
    figures.push_back(orbit_in_space(space, orbit, what));
  }
  if (count <= 2) figures.push_back(portrait(method, scene, orbit, what));
  return figures;
}

}  // namespace hamgen::app
