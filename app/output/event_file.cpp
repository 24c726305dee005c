#include "app/output/event_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/studies/setting.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

// The state's columns with their numbers.
std::vector<std::pair<std::string, double>> state_cells(const std::vector<std::string>& names,
                                                        const std::vector<runtime::Wide>& state,
                                                        bool wide) {
  std::vector<std::pair<std::string, double>> cells;
  for (std::size_t i = 0; i < names.size(); ++i) cells.emplace_back(names[i], state[i].hi);
  for (std::size_t i = 0; wide && i < names.size(); ++i) {
    std::string low = names[i] + "_lo";
    while (std::ranges::find(names, low) != names.end()) low += '_';
    cells.emplace_back(low, state[i].lo);
  }
  return cells;
}

std::string json_text_of(const std::string& text) { return nlohmann::json(text).dump(); }

// JSON has no nan.
std::string json_number(double value) {
  const std::string text = runtime::number_text(value);
  return text.empty() ? "null" : text;
}

}  // namespace

EventFile::EventFile(const std::string& path, const std::vector<std::string>& metadata,
                     std::vector<std::string> state, bool wide)
    : json_(path.ends_with(".json")),
      wide_(wide),
      state_(std::move(state)),
      time_(time_column(state_)),
      file_(path) {
  if (json_) {
    std::string remarks;
    for (const std::string& line : metadata)
      remarks += (remarks.empty() ? "" : ", ") + json_text_of(line);
    file_.write(fmt::format("{{\"about\": [{}],\n \"events\": [", remarks));
    return;
  }
  std::string head;
  for (const std::string& line : metadata) head += "# " + comment_text(line) + "\n";
  head += "event," + time_ + ",steps,fraction";
  const std::vector<runtime::Wide> nothing(state_.size());
  for (const auto& [name, value] : state_cells(state_, nothing, wide_))
    head += "," + runtime::csv_cell(name);
  file_.write(head + "\n");
}

void EventFile::add(const std::string& event, const WatchedPoint& point,
                    const std::vector<runtime::Wide>& state) {
  ++count_;
  const auto cells = state_cells(state_, state, wide_);
  if (!json_) {
    std::string line = fmt::format("{},{},{},{}", event, runtime::number_text(point.time),
                                   point.steps, runtime::number_text(point.fraction));
    for (const auto& [name, value] : cells) line += "," + runtime::number_text(value);
    file_.write(line + "\n");
    return;
  }
  std::string line =
      fmt::format("{}\n  {{\"event\": {}, \"{}\": {}, \"steps\": {}, \"fraction\": {}",
                  count_ == 1 ? "" : ",", json_text_of(event), time_, json_number(point.time),
                  point.steps, json_number(point.fraction));
  for (const auto& [name, value] : cells)
    line += fmt::format(", {}: {}", json_text_of(name), json_number(value));
  file_.write(line + "}");
}

void EventFile::publish(const std::string& outcome) {
  file_.write(json_ ? fmt::format("],\n \"outcome\": {}}}\n", json_text_of(outcome))
                    : "# " + comment_text(outcome) + "\n");
  file_.publish();
}

void require_event_file_name(const std::string& path) {
  if (path.ends_with(".csv") || path.ends_with(".json")) return;
  throw UsageError(fmt::format("--events {}: the name ends in .csv or .json", path));
}

}  // namespace hamgen::app
