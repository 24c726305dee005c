// What is done of an ensemble, kept beside its output until that can be written.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/studies/ensemble.hpp"
#include "runtime/directory_lock.hpp"
#include "runtime/part_file.hpp"

namespace hamgen::app {

// What an ensemble is: two with the same lines have the same rows.
struct EnsembleManifest {
  std::vector<std::string> lines;    // "h         0.1": a label of 10 columns and a value
  std::vector<std::string> columns;  // of a row
  long long count = 0;               // of trajectories
  long long block = 1;               // of them in a record

  [[nodiscard]] long long blocks() const { return (count + block - 1) / block; }
  [[nodiscard]] long long rows_of(long long number) const {
    return std::min(block, count - number * block);
  }
};

// "x.csv.parts" of "x.csv".
[[nodiscard]] std::filesystem::path parts_directory(const std::filesystem::path& output);

// The lines that differ, "there" and "here"; empty if none do.
[[nodiscard]] std::string difference_of(const std::vector<std::string>& there,
                                        const std::vector<std::string>& here);

// The directory, in the hands of one process, or of the processes of one crew.
class EnsembleParts {
 public:
  // Makes it, or goes on with it if `resume` says so.  Throws UsageError where it is of another
  // ensemble, or of the same and nobody said that it goes on; ToolError, if another process works
  // there.
  EnsembleParts(const std::filesystem::path& output, const EnsembleManifest& manifest, bool resume);

  // Reads and checks all part files.
  void scan();
  // Blocks that are in none of them, in order.
  [[nodiscard]] std::vector<long long> missing() const;
  // Records whose bytes were not what was written, and which are done again.
  [[nodiscard]] long long spoilt() const { return spoilt_; }
  // All of them, once nothing is missing, block after block.
  void read(const std::function<void(const std::vector<EnsembleRow>&)>& take) const;
  // Once the output is written.
  void remove();

 private:
  void check(const EnsembleManifest& manifest, bool resume);

  struct Found {
    int file = -1;
    runtime::PartRecord record;
  };
  std::filesystem::path directory_;
  EnsembleManifest manifest_;
  runtime::DirectoryLock lock_;
  std::vector<std::filesystem::path> files_;
  std::vector<Found> found_;  // of each block
  long long spoilt_ = 0;
};

// The one that this rank appends to.
[[nodiscard]] std::filesystem::path part_path(const std::filesystem::path& output, int rank);

}  // namespace hamgen::app
