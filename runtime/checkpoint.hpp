// A run on disk, to go on with in another process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/trajectory.hpp"

namespace hamgen::runtime {

struct Checkpoint {
  std::vector<std::string> manifest;  // what the run is, one line each
  RunState state;
  std::uint64_t rows_size = 0;      // bytes of the file of rows
  std::uint64_t rows_checksum = 0;  // CRC-64 of these
};

// Aside, until it is on the disk, then renamed: there is always a whole one.  Throws ToolError.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
// Throws ToolError if it cannot be read, is none, is of another version of this format, or is not
// whole.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& path);

}  // namespace hamgen::runtime
