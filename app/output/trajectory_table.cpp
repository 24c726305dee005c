#include "app/output/trajectory_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/output/terminal.hpp"
#include "app/studies/setting.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

std::vector<std::string> comment_texts(const std::vector<std::string>& metadata) {
  std::vector<std::string> texts;
  for (const std::string& line : metadata) texts.push_back(comment_text(line));
  return texts;
}

}  // namespace

std::vector<std::string> column_names(const Columns& columns) {
  std::vector<std::string> names = {"step", time_column(columns.state)};
  names.insert(names.end(), columns.state.begin(), columns.state.end());
  if (columns.energy) names.emplace_back(columns.has_time ? "H+p_t" : "H");
  names.insert(names.end(), columns.invariants.begin(), columns.invariants.end());
  if (!columns.wide) return names;
  const std::size_t first = 2;  // behind step and t
  for (std::size_t i = first, end = names.size(); i < end; ++i) {
    std::string low = names[i] + "_lo";
    while (std::ranges::find(names, low) != names.end()) low += '_';  // a variable of that name
    names.push_back(low);
  }
  return names;
}

std::vector<double> row_values(const Columns& columns, const runtime::Record& record) {
  std::vector<runtime::Wide> values;
  for (const std::size_t place : columns.state_places) values.push_back(record.state[place]);
  if (columns.energy) values.push_back(record.energy);
  for (const std::size_t place : columns.places) values.push_back(record.invariants[place]);
  std::vector<double> row = {record.time};
  for (const runtime::Wide& value : values) row.push_back(value.hi);
  if (columns.wide) {
    for (const runtime::Wide& value : values) row.push_back(value.lo);
  }
  return row;
}

TrajectoryTable::TrajectoryTable(const std::string& target,
                                 const std::vector<std::string>& metadata, Columns columns)
    : columns_(std::move(columns)) {
  const std::vector<std::string> names = column_names(columns_);
  if (target != "-") {
    file_ = std::make_unique<runtime::CsvWriter>(target, comment_texts(metadata), names);
    return;
  }
  std::string head;
  for (const std::string& line : comment_texts(metadata)) head += "# " + line + "\n";
  print(fmt::format("{}{}\n", head, fmt::join(names, ",")));
}

TrajectoryTable::TrajectoryTable(const std::string& target,
                                 const std::vector<std::string>& metadata, Columns columns,
                                 const runtime::AtomicFile::Part& from, long long rows)
    : columns_(std::move(columns)),
      file_(std::make_unique<runtime::CsvWriter>(target, comment_texts(metadata),
                                                 column_names(columns_), from)),
      rows_(rows) {}

void TrajectoryTable::add(const runtime::Record& record) {
  ++rows_;
  const std::vector<double> row = row_values(columns_, record);
  if (file_) {
    file_->write_row(record.step, row);
    return;
  }
  std::string line = fmt::format("{}", record.step);
  for (const double value : row) line += "," + runtime::number_text(value);
  print_buffered(line + "\n");
}

void TrajectoryTable::publish(const std::string& remark) {
  if (file_) {
    file_->publish(comment_text(remark));
  } else {
    print(remark.empty() ? "" : "# " + comment_text(remark) + "\n");
  }
}

}  // namespace hamgen::app
