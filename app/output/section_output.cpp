#include "app/output/section_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/output/json_document.hpp"
#include "app/output/kept_text.hpp"
#include "app/output/math_symbol.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

long points_of(const Section& section) {
  long count = 0;
  for (const SectionOrbit& orbit : section.orbits) count += static_cast<long>(orbit.points.size());
  return count;
}

// No step of it failed.
bool went_well(const SectionOrbit& orbit) {
  return orbit.status == runtime::Status::done || orbit.status == runtime::Status::stopped;
}

// Of the orbits no step of which failed, relative to the scale of each; absolute where one has
// none.
std::string energy_kept(const Section& section) {
  double largest = 0.0;
  double scale = 0.0;
  double relative = 0.0;
  if (std::ranges::none_of(section.orbits, went_well)) return "";
  for (const SectionOrbit& orbit : section.orbits) {
    if (!went_well(orbit)) continue;
    largest = std::max(largest, orbit.largest_error);
    scale = std::max(scale, orbit.energy_scale);
    if (orbit.energy_scale > 0.0)
      relative = std::max(relative, orbit.largest_error / orbit.energy_scale);
  }
  return ", kept to " + kept_text(relative > 0.0 ? relative * scale : largest, scale);
}

// How orbits ended that did not come to their end, and how many did so.
std::map<std::string, int> endings_of(const Section& section) {
  std::map<std::string, int> endings;
  for (const SectionOrbit& orbit : section.orbits) {
    if (orbit.status != runtime::Status::done)
      ++endings[std::string(runtime::to_text(orbit.status))];
  }
  return endings;
}

// An expression as the name of a column.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted;
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return '"' + quoted + '"';
}

// Of some that ended: where those began that did not.
std::string advice(const Section& section, const SectionTitle& title) {
  std::vector<double> first;
  std::vector<double> second;
  for (const SectionOrbit& orbit : section.orbits) {
    if (orbit.status != runtime::Status::done) continue;
    first.push_back(orbit.first);
    second.push_back(orbit.second);
  }
  if (first.size() < 2) return "help: a smaller --h\n";
  const auto [left, right] = std::ranges::minmax(first);
  const auto [low, high] = std::ranges::minmax(second);
  return fmt::format(
      "help: a smaller --h; those that did not end began in {}={:.3g}:{:.3g}, {}={:.3g}:{:.3g}, "
      "and --from 'A=LOW:HIGH,B=LOW:HIGH' says where orbits begin\n",
      title.first, left, right, title.second, low, high);
}

std::string angles_line(const SectionTitle& title) {
  if (title.angles.empty()) return "";
  return fmt::format("# angles    {}, from -pi to pi\n", fmt::join(title.angles, ", "));
}

bool is_angle(const SectionTitle& title, const std::string& axis) {
  return std::ranges::find(title.angles, axis) != title.angles.end();
}
// Of a picture.
std::string axis_label(const SectionTitle& title, const std::string& axis) {
  return plain_symbol(axis) + (is_angle(title, axis) ? " (mod 2 pi)" : "");
}

std::string of_scene(const SectionTitle& title) {
  return title.scene.empty() ? title.model : title.model + ", scene " + title.scene;
}

}  // namespace

std::string section_summary(const Section& section, const SectionTitle& title) {
  std::string text = fmt::format(
      "{}: section {}\n  scheme     {}, h = {:.10g}\n  energy     {:.10g}{}\n"
      "  orbits     {}, {} crossings\n",
      of_scene(title), title.surface, title.scheme, title.h, title.energy, energy_kept(section),
      section.orbits.size(), points_of(section));
  if (section.unreachable > 0)
    text += fmt::format("  starts     no momentum has this energy at {} of {} that were tried\n",
                        section.unreachable, section.tried);
  for (const auto& [ending, count] : endings_of(section))
    text += fmt::format("  ended      {} of the orbits: {}\n", count, ending);
  if (!std::ranges::all_of(section.orbits, went_well)) text += advice(section, title);
  const auto without = std::ranges::count_if(section.orbits, [](const SectionOrbit& orbit) {
    return orbit.status == runtime::Status::done && orbit.points.empty();
  });
  if (without > 0)
    text += fmt::format("  never      {} of the orbits did not cross it in {} steps\n", without,
                        section.orbits.front().steps);
  return text;
}

std::string section_csv(const Section& section, const SectionTitle& title) {
  std::string text =
      fmt::format("# made by   hamgen " HAMGEN_VERSION
                  "\n# section   {} of {}\n# scheme    {}, h = {}\n"
                  "# energy    {}\n{}orbit,t,{},{}\n",
                  title.surface, of_scene(title), title.scheme, runtime::number_text(title.h),
                  runtime::number_text(title.energy), angles_line(title), csv_field(title.first),
                  csv_field(title.second));
  for (std::size_t i = 0; i < section.orbits.size(); ++i) {
    for (const SectionPoint& point : section.orbits[i].points)
      text += fmt::format("{},{},{},{}\n", i + 1, runtime::number_text(point.time),
                          runtime::number_text(point.first), runtime::number_text(point.second));
  }
  for (const auto& [ending, count] : endings_of(section))
    text += fmt::format("# ended     {} of the orbits: {}\n", count, ending);
  return text;
}

std::string section_json(const Section& section, const SectionTitle& title) {
  using Json = nlohmann::ordered_json;
  Json orbits = Json::array();
  for (const SectionOrbit& orbit : section.orbits) {
    Json points = Json::array();
    for (const SectionPoint& point : orbit.points)
      points.push_back({point.time, point.first, point.second});
    orbits.push_back({{"start", {orbit.first, orbit.second}},
                      {"status", runtime::to_text(orbit.status)},
                      {"steps", orbit.steps},
                      {"max_energy_error", orbit.largest_error},
                      {"energy_scale", orbit.energy_scale},
                      {"points", points}});
  }
  return json_document({{"model", title.model},
                        {"scene", title.scene},
                        {"scheme", title.scheme},
                        {"h", title.h},
                        {"surface", title.surface},
                        {"axes", {title.first, title.second}},
                        {"angles", title.angles},
                        {"energy", title.energy},
                        {"starts_tried", section.tried},
                        {"starts_without_momentum", section.unreachable},
                        {"orbits", orbits}});
}

Plot section_plot(const Section& section, const SectionTitle& title) {
  PlotPanel panel{
      .title = fmt::format("{}: {}, H = {:.6g}", title.model, title.surface, title.energy),
      .x_label = axis_label(title, title.first),
      .y_label = axis_label(title, title.second),
      .series = {}};
  for (std::size_t i = 0; i < section.orbits.size(); ++i) {
    PlotSeries series{.label = "", .points = {}, .style = PlotStyle::dots};
    for (const SectionPoint& point : section.orbits[i].points)
      series.points.push_back({point.first, point.second});
    if (!series.points.empty()) panel.series.push_back(std::move(series));
  }
  return {.panels = {std::move(panel)}, .width = 720, .height = 640};
}

}  // namespace hamgen::app
