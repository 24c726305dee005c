// Maps of an indicator of chaos.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/output/chaos_output.hpp"
#include "app/output/json_document.hpp"
#include "app/output/math_symbol.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

std::vector<double> at(const ChaosMapTable& map, std::size_t cell) {
  const std::size_t across = (*map.axes)[0].values.size();
  std::vector<double> place = {(*map.axes)[0].values[cell % across]};
  if (map.axes->size() > 1) place.push_back((*map.axes)[1].values[cell / across]);
  return place;
}

// Of the cells that came to their end.
std::vector<std::optional<double>> values_of(const ChaosMapTable& map, const Indicator& indicator) {
  std::vector<std::optional<double>> values;
  for (const ChaosCell& cell : *map.cells) {
    std::optional<double> value;
    if (cell.status == runtime::Status::done && cell.end) value = indicator.value(*cell.end);
    if (value && !std::isfinite(*value)) value.reset();
    values.push_back(value);
  }
  return values;
}

// The middle nine tenths of the values: single ones do not take the colours of the others.
std::optional<std::pair<double, double>> range_of(
    const std::vector<std::optional<double>>& values) {
  std::vector<double> sorted;
  for (const auto& value : values) {
    if (value) sorted.push_back(*value);
  }
  if (sorted.empty()) return {};
  std::ranges::sort(sorted);
  return std::pair(sorted[sorted.size() / 20], sorted[sorted.size() - 1 - sorted.size() / 20]);
}

}  // namespace

std::string chaos_map_text(const ChaosMapTable& map, const Indicator& indicator,
                           const ChaosTitle& title) {
  std::map<std::string, int> outcomes;
  for (const ChaosCell& cell : *map.cells) ++outcomes[std::string(to_text(cell.status))];
  std::string text = fmt::format("{}{}\n  scheme     {}, h = {:.10g}\n  cells      {}", title.model,
                                 title.scene.empty() ? "" : ", scene " + title.scene, title.scheme,
                                 title.h, map.cells->size());
  for (const auto& [outcome, count] : outcomes) text += fmt::format(", {} {}", count, outcome);
  const std::optional<std::pair<double, double>> range = range_of(values_of(map, indicator));
  if (!range) return text + fmt::format("\n  {:10} of no cell\n", indicator.name);
  return text + fmt::format("\n  {:10} nine in ten between {:.4g} and {:.4g}\n", indicator.name,
                            range->first, range->second);
}

std::string chaos_map_csv(const ChaosMapTable& map, const ChaosTitle& title) {
  using runtime::number_text;
  std::string text =
      fmt::format("# made by   hamgen " HAMGEN_VERSION "\n# model     {}\n# scheme    {}, h = {}\n",
                  title.model, title.scheme, number_text(title.h));
  for (const ChaosAxis& axis : *map.axes) text += axis.name + ",";
  text += "status,t,lyapunov,megno,fli,sali\n";
  for (std::size_t i = 0; i < map.cells->size(); ++i) {
    const ChaosCell& cell = (*map.cells)[i];
    for (const double value : at(map, i)) text += number_text(value) + ",";
    text += to_text(cell.status);
    const auto add = [&](double ChaosSample::*field) {
      text += "," + (cell.end ? number_text((*cell.end).*field) : "");
    };
    add(&ChaosSample::time);
    add(&ChaosSample::lyapunov);
    add(&ChaosSample::megno);
    add(&ChaosSample::fli);
    add(&ChaosSample::sali);
    text += "\n";
  }
  return text;
}

std::string chaos_map_json(const ChaosMapTable& map, const ChaosTitle& title) {
  using Json = nlohmann::ordered_json;
  Json axes = Json::array();
  for (const ChaosAxis& axis : *map.axes)
    axes.push_back({{"name", axis.name}, {"values", axis.values}});
  Json cells = Json::array();
  for (const ChaosCell& cell : *map.cells) {
    Json row = {{"status", to_text(cell.status)}};
    if (!cell.reason.empty()) row["reason"] = cell.reason;
    if (cell.end) {
      row["t"] = cell.end->time;
      row["lyapunov"] = cell.end->lyapunov;
      row["megno"] = cell.end->megno;
      row["fli"] = cell.end->fli;
      row["sali"] = cell.end->sali;
    }
    cells.push_back(row);
  }
  return json_document({{"model", title.model},
                        {"scene", title.scene},
                        {"scheme", title.scheme},
                        {"h", title.h},
                        {"axes", axes},
                        {"cells", cells}});
}

std::string chaos_map_script(const ChaosMapTable& map, const Indicator& indicator,
                             const ChaosTitle& title, const std::string& output) {
  const std::vector<std::optional<double>> values = values_of(map, indicator);
  const ChaosAxis& x = (*map.axes)[0];
  if (map.axes->size() == 1) {
    PlotSeries line{.label = "", .points = {}, .style = PlotStyle::lines_and_points};
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i]) line.points.push_back({x.values[i], *values[i]});
    }
    return gnuplot_script({.panels = {{.title = title.model,
                                       .x_label = plain_symbol(x.name),
                                       .y_label = indicator.label,
                                       .series = {line}}},
                           .width = 720},
                          output);
  }
  const auto [low, high] = range_of(values).value_or(std::pair(0.0, 1.0));
  return heat_map_script({.title = title.model,
                          .x_label = plain_symbol(x.name),
                          .y_label = plain_symbol((*map.axes)[1].name),
                          .value_label = indicator.label,
                          .x = x.values,
                          .y = (*map.axes)[1].values,
                          .values = values,
                          .low = low,
                          .high = high > low ? high : low + 1.0},
                         output);
}

}  // namespace hamgen::app
