// Files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "runtime/file_descriptor.hpp"

namespace hamgen::runtime {

// Collects text under a temporary name beside the target and renames it in publish(); without
// publish() nothing is left behind.  A link is followed: the file it points to is replaced.  What
// is not an ordinary file (a terminal, a pipe, /dev/null) is written directly instead, and never
// replaced.  All members throw ToolError naming the target.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);

  // The beginning of a file.
  struct Part {
    std::uint64_t size = 0;
    std::uint64_t checksum = 0;  // CRC-64
  };
  // The same under the name TARGET.part, which others can read and which stays whatever happens
  // before publish(): it goes on behind `from` of what is there, or of the target if that has been
  // published.  Throws ToolError if that is not there any more.
  AtomicFile(const std::filesystem::path& target, const Part& from);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  void write(std::string_view text);
  // Until what was written is on the disk, so that a power cut after publish() finds it.
  void sync();
  // What is on the disk then.
  [[nodiscard]] Part synced();
  void publish();

  [[nodiscard]] const std::filesystem::path& target() const { return target_; }

 private:
  void flush();
  void discard();

  std::filesystem::path target_;     // as given
  std::filesystem::path final_;      // links followed
  std::filesystem::path temporary_;  // empty if the target is written directly
  FileDescriptor file_;
  std::string buffer_;
  bool is_kept_ = false;
  Part written_;  // if it is kept
};

// Throws ToolError where the file could not be written, before something takes long for it.  A
// folder that is missing will be made.
void require_writable(const std::filesystem::path& target);

// Makes a file hold exactly the text; creates missing directories.  An equal file is not touched,
// so that nothing that depends on it is rebuilt.  Returns whether the file changed.  Throws
// ToolError.
bool atomic_write(const std::filesystem::path& path, std::string_view text);

// Gives a file that was written aside, by a library say, its name, once it is on the disk.  Throws
// ToolError naming the target.
void publish_file(const std::filesystem::path& aside, const std::filesystem::path& target);

// The whole file; throws ToolError.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace hamgen::runtime
