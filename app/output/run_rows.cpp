#include "app/output/run_rows.hpp"

#include <algorithm>
#include <iterator>

namespace hamgen::app {

RunRows::RunRows(std::optional<TrajectoryTable> table, bool is_drawn, Columns columns,
                 std::optional<double> energy_scale)
    : columns_(std::move(columns)), table_(std::move(table)) {
  if (!is_drawn) return;
  drawn_.emplace().columns = column_names(columns_);
  drawn_->energy_scale = energy_scale;
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
