// A table of numbers small enough to draw.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hamgen::app {

struct NumberTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  // a value for each column; not a number where it has none
  // Of the rows there were, how far those kept are apart; where it is more than 1, the least and
  // the greatest of each column from a row kept until the next.
  long long each = 1;
  std::vector<std::vector<double>> low, high;
  bool is_whole = true;                // a trajectory file that ends with its status
  std::optional<double> energy_scale;  // that energy errors are compared with, where it is known

  // Keeps every row at first, then every second, fourth, ...: at most as many as can be told apart.
  void add(const std::vector<double>& row);

 private:
  long long seen_ = 0;
};

// The remark that says it in such a file.
[[nodiscard]] std::string energy_scale_remark(double scale);

// Of a file as `run -o` writes it: remarks, a line of names, rows.  Throws UsageError with the
// place where it is something else, or cut off within a line.
[[nodiscard]] NumberTable read_number_table(const std::filesystem::path& path);

}  // namespace hamgen::app
