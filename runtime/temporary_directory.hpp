// A fresh private directory that is removed, with all in it, when it goes out of scope.
#pragma once

#include <filesystem>
#include <string_view>

namespace hamgen::runtime {

class TemporaryDirectory {
 public:
  // Creates PARENT/PREFIX MACHINE-PROCESS-xxxxxx with mode 0700, and removes what dead processes
  // left there under such names.  Throws ToolError.
  TemporaryDirectory(const std::filesystem::path& parent, std::string_view prefix);
  TemporaryDirectory(TemporaryDirectory&& other) noexcept;
  TemporaryDirectory& operator=(TemporaryDirectory&&) = delete;
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  ~TemporaryDirectory();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// One in $TMPDIR, else in /tmp.
[[nodiscard]] TemporaryDirectory private_directory();

}  // namespace hamgen::runtime
