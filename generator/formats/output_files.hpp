// Files that exist in memory only; writing them is the last act of a command.
#pragma once

#include <string>
#include <vector>

namespace hamgen {

struct OutputFile {
  std::string path;  // relative to the output directory
  std::string text;
  bool operator==(const OutputFile&) const = default;
};
using OutputFiles = std::vector<OutputFile>;

}  // namespace hamgen
