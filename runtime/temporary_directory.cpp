#include "runtime/temporary_directory.hpp"

#include <stdlib.h>

#include <cerrno>
#include <string>
#include <utility>

#include "runtime/temporary_name.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {

TemporaryDirectory::TemporaryDirectory(const std::filesystem::path& parent,
                                       std::string_view prefix) {
  collect_left_overs(parent, prefix);
  std::string name = (parent / prefix).string() + process_tag() + "XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) {
    throw file_error("create a temporary directory in", parent, errno);
  }
  path_ = name;
}

TemporaryDirectory::TemporaryDirectory(TemporaryDirectory&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

TemporaryDirectory private_directory() {
  const char* const chosen = std::getenv("TMPDIR");
  const bool usable = chosen != nullptr && chosen[0] == '/';
  return TemporaryDirectory(usable ? chosen : "/tmp", "hamgen-");
}

}  // namespace hamgen::runtime
