// One process at a time in a directory.
#pragma once

#include <filesystem>

#include "runtime/file_descriptor.hpp"

namespace hamgen::runtime {

// Held until it goes out of scope, or the process ends in whatever way.  A file system without
// locks has none.
class DirectoryLock {
 public:
  DirectoryLock() = default;
  // Throws ToolError if another process has it.
  explicit DirectoryLock(const std::filesystem::path& directory);

 private:
  FileDescriptor file_;
};

}  // namespace hamgen::runtime
