#include "app/output/trajectory_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/output/terminal.hpp"

namespace hamgen::app {
namespace {

std::vector<std::string> column_names(const Columns& columns) {
  // Of a model with a variable t of its own, that is the one; the run's clock begins at 0.
  const bool has_t = std::ranges::find(columns.state, "t") != columns.state.end();
  std::vector<std::string> names = {"step", has_t ? "elapsed" : "t"};
  names.insert(names.end(), columns.state.begin(), columns.state.end());
  if (columns.energy) names.emplace_back(columns.has_time ? "H+p_t" : "H");
  names.insert(names.end(), columns.invariants.begin(), columns.invariants.end());
  return names;
}

std::string remark_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return "# " + text + "\n";
}

}  // namespace

TrajectoryTable::TrajectoryTable(const std::string& target,
                                 const std::vector<std::string>& metadata, Columns columns)
    : columns_(std::move(columns)) {
  const std::vector<std::string> names = column_names(columns_);
  if (target != "-") {
    file_ = std::make_unique<runtime::CsvWriter>(target, metadata, names);
    return;
  }
  std::string head;
  for (const std::string& line : metadata) head += remark_line(line);
  print(fmt::format("{}{}\n", head, fmt::join(names, ",")));
}

void TrajectoryTable::add(const runtime::Record& record) {
  values_ = {record.time};
  values_.insert(values_.end(), record.state.begin(), record.state.end());
  if (columns_.energy) values_.push_back(record.energy);
  for (const std::size_t place : columns_.places) values_.push_back(record.invariants[place]);
  ++rows_;
  if (file_) {
    file_->write_row(record.step, values_);
    return;
  }
  std::string line = fmt::format("{}", record.step);
  for (const double value : values_) line += "," + runtime::number_text(value);
  print_buffered(line + "\n");
}

void TrajectoryTable::publish(const std::string& remark) {
  if (file_) {
    file_->publish(remark);
  } else {
    print(remark.empty() ? "" : remark_line(remark));
  }
}

}  // namespace hamgen::app
