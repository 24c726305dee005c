// Where the records of a run go: a table, a picture, or both.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/output/number_table.hpp"
#include "app/output/trajectory_table.hpp"

namespace hamgen::app {

class RunRows {
 public:
  // Into the table, if there is one; `is_drawn`: for a picture too.
  RunRows(std::optional<TrajectoryTable> table, bool is_drawn, Columns columns,
          std::optional<double> energy_scale);

  [[nodiscard]] bool wanted() const { return table_ || drawn_; }
  [[nodiscard]] std::optional<TrajectoryTable>& table() { return table_; }
  [[nodiscard]] const std::optional<NumberTable>& drawn() const { return drawn_; }
  // Of the last one.
  [[nodiscard]] std::optional<double> time() const { return time_; }

  void add(const runtime::Record& record);

 private:
  Columns columns_;
  std::optional<TrajectoryTable> table_;
  std::optional<NumberTable> drawn_;
  std::optional<double> time_;
};

}  // namespace hamgen::app
