// Which trajectories an ensemble has: their number, and what each of them begins with.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hamgen::app {

// Evenly spaced values of a parameter, a coordinate or a momentum, both ends among them.
struct EnsembleAxis {
  std::string name;
  double low = 0.0, high = 0.0;
  long long count = 1;
};

enum class Distribution { uniform, normal };

// A value that is drawn anew for each trajectory.
struct EnsembleDraw {
  std::string name;
  Distribution distribution = Distribution::uniform;
  double a = 0.0, b = 1.0;  // ends, or mean and standard deviation
};

// Rows of a file.
struct EnsembleTable {
  std::string path, digest;  // SHA-256 of its text
  std::vector<std::string> names;
  std::vector<double> values;  // row by row
  [[nodiscard]] long long rows() const {
    return names.empty() ? 1 : static_cast<long long>(values.size() / names.size());
  }
};

// Every row of the table at every point of the grid, each so many times with other random values.
struct EnsemblePlan {
  EnsembleTable table;
  std::vector<EnsembleAxis> axes;
  std::vector<EnsembleDraw> draws;
  long long draws_each = 1;
  std::uint64_t seed = 0;

  // Those of the table, the axes and the draws.
  [[nodiscard]] std::vector<std::string> names() const;
  // As a double: it may be beyond all integers.
  [[nodiscard]] double size() const;
  [[nodiscard]] long long count() const { return static_cast<long long>(size()); }
  // Of trajectory `index`, one value a name: rows of the table slowest, then the last axis, the
  // first axis, and the draws fastest.  Depends on nothing else.
  void values(long long index, std::span<double> values) const;
  // What decides them, one line each.
  [[nodiscard]] std::vector<std::string> to_text() const;
};

// More would fill the largest disks.
inline constexpr long long kMostTrajectories = 10'000'000'000;

// A CSV file: lines of comment (#), a line of names, then numbers.  Throws UsageError with the line
// that is wrong, ToolError.
[[nodiscard]] EnsembleTable read_ensemble_table(const std::string& path);

}  // namespace hamgen::app
