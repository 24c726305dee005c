// The trajectory as a table of columns step, t, q, p, H and the invariants.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/csv_writer.hpp"
#include "runtime/trajectory.hpp"

namespace hamgen::app {

// What a row holds besides step and t.  Of a wide scalar each value is in two columns, x and,
// behind all of these, x_lo: it is their sum.
struct Columns {
  std::vector<std::string> state;         // names: q then p
  std::vector<std::size_t> state_places;  // of these in the record's state
  bool energy = true;
  bool has_time = false;                // H stands for H + p_t
  std::vector<std::string> invariants;  // names
  std::vector<std::size_t> places;      // of these among the record's invariants
  bool wide = false;                    // the scalar's digits are more than a double's
};

// "step", "t", then what they hold.
[[nodiscard]] std::vector<std::string> column_names(const Columns& columns);
// Of a record, a value for each of the names but the first.
[[nodiscard]] std::vector<double> row_values(const Columns& columns, const runtime::Record& record);

class TrajectoryTable {
 public:
  // The target "-" is standard output, where rows appear as they come.
  TrajectoryTable(const std::string& target, const std::vector<std::string>& metadata,
                  Columns columns);
  // A file that others can read while it grows; goes on behind `from`, with so many rows.
  TrajectoryTable(const std::string& target, const std::vector<std::string>& metadata,
                  Columns columns, const runtime::AtomicFile::Part& from, long long rows);

  // What of it is on the disk then; not of standard output.
  [[nodiscard]] runtime::AtomicFile::Part synced() { return file_->synced(); }

  void add(const runtime::Record& record);
  // Makes a file visible; the remark, if any, becomes its last line.
  void publish(const std::string& remark);

  [[nodiscard]] long long rows() const { return rows_; }

 private:
  Columns columns_;
  std::unique_ptr<runtime::CsvWriter> file_;  // null for standard output
  long long rows_ = 0;
};

}  // namespace hamgen::app
