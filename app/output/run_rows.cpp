#include "app/output/run_rows.hpp"

#include <algorithm>
#include <iterator>

namespace hamgen::app {

RunRows::RunRows(const std::string& output, bool is_drawn, Columns columns,
                 const std::vector<std::string>& remarks)
    : columns_(std::move(columns)) {
  if (!output.empty()) table_.emplace(output, remarks, columns_);
  if (is_drawn) drawn_.emplace().columns = column_names(columns_);
}

void RunRows::add(const runtime::Record& record) {
  time_ = record.time;
  if (table_) table_->add(record);
  if (!drawn_) return;
  std::vector<double> row = {static_cast<double>(record.step)};
  std::ranges::copy(row_values(columns_, record), std::back_inserter(row));
  drawn_->add(row);
}

}  // namespace hamgen::app
