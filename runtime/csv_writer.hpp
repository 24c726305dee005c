// Trajectories as comma-separated values that read back to the same numbers.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/atomic_file.hpp"

namespace hamgen::runtime {

// The file has lines `# TEXT` of metadata, a line of column names, then rows.  The first column is
// the step's number; the others are doubles in the fewest digits that read back to the same double,
// whatever the locale; a value that is not finite is left empty.  Written aside and renamed by
// publish(); without it (an exception, a failed disk) nothing is left.  All throw ToolError.
class CsvWriter {
 public:
  // `columns` names all columns, that of the step included.
  CsvWriter(const std::filesystem::path& target, std::span<const std::string> metadata,
            std::span<const std::string> columns);
  // The same, kept under the name TARGET.part (see AtomicFile); goes on behind `from`, if that is
  // not empty, with its rows.
  CsvWriter(const std::filesystem::path& target, std::span<const std::string> metadata,
            std::span<const std::string> columns, const AtomicFile::Part& from);

  // What is on the disk then.
  [[nodiscard]] AtomicFile::Part synced() { return file_.synced(); }

  // Throws std::invalid_argument if the number of values is not that of the columns after the
  // first.
  void write_row(long long step, std::span<const double> values);

  // Makes the file visible, with more metadata at its end if something has to be said about it
  // ("stopped at step 12: not converged").
  void publish(std::string_view last_remark = {});

  [[nodiscard]] long long rows() const { return rows_; }

 private:
  void write_head(std::span<const std::string> metadata, std::span<const std::string> columns);

  AtomicFile file_;
  std::size_t columns_;
  long long rows_ = 0;
  std::string line_;
};

// The fewest digits that read back to the same double; empty if it is not finite.
[[nodiscard]] std::string number_text(double value);

// A text as one cell, quoted where it must be; line breaks become blanks.
[[nodiscard]] std::string csv_cell(std::string text);

}  // namespace hamgen::runtime
