// The results of an ensemble as one file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/ensemble_parts.hpp"

namespace hamgen::app {

// Written aside; publish() gives it its name.
class EnsembleFile {
 public:
  EnsembleFile() = default;
  EnsembleFile(const EnsembleFile&) = delete;
  EnsembleFile& operator=(const EnsembleFile&) = delete;
  virtual ~EnsembleFile() = default;

  // The next of them, in the order of their indices.
  virtual void add(const std::vector<EnsembleRow>& rows) = 0;
  // `remark` is on how they ended.
  virtual void publish(const std::string& remark) = 0;
};

// A row is index, what was varied (the first `varied` columns), status, steps, and the rest.
struct EnsembleFileHead {
  const EnsembleManifest* manifest = nullptr;
  std::size_t varied = 0;
};

// By the name's ending: .csv, .h5 or .hdf5.  Throws UsageError for another one, and for HDF5 where
// hamgen was built without.
enum class EnsembleFormat { csv, hdf5 };
[[nodiscard]] EnsembleFormat ensemble_format(const std::string& output);

[[nodiscard]] std::unique_ptr<EnsembleFile> make_ensemble_file(const std::string& output,
                                                               const EnsembleFileHead& head);
// Does the file that is there go on to its end?
[[nodiscard]] bool is_whole(const std::string& output);
// The manifest's lines of a file that is there; empty if there is none or it has no such lines.
[[nodiscard]] std::vector<std::string> manifest_lines_of(const std::string& output);

// These are in a file of their own: without HDF5 that says which package brings it.
[[nodiscard]] bool has_hdf5();
[[nodiscard]] std::unique_ptr<EnsembleFile> make_ensemble_hdf5(const std::string& output,
                                                               const EnsembleFileHead& head);
[[nodiscard]] std::vector<std::string> manifest_lines_of_hdf5(const std::string& path);

}  // namespace hamgen::app
