// Files that exist in memory only; writing them is the last act of a command.
#pragma once

#include <string>
#include <vector>

namespace hamgen {

struct OutputFile {
  enum class Role { needed, beside };
  std::string path;  // relative to the output directory
  std::string text;
  Role role = Role::needed;  // or what the others do without
  bool operator==(const OutputFile&) const = default;
};
using OutputFiles = std::vector<OutputFile>;

}  // namespace hamgen
