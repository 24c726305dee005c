#include "runtime/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string_view>

#include "runtime/crc64.hpp"
#include "runtime/kill_point.hpp"
#include "runtime/temporary_name.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBufferSize = 1 << 16;

// Opens a new file beside the target; sets `temporary` to its name.
FileDescriptor open_beside(const fs::path& final_path, const fs::path& target,
                           fs::path& temporary) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    temporary = temporary_name(final_path);
    FileDescriptor file(
        ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666));
    if (file.is_open()) return file;
    if (errno != EEXIST) break;
  }
  const int error_number = errno;
  temporary.clear();
  throw file_error("write", target, error_number);
}

bool begins_with(const fs::path& path, const AtomicFile::Part& part) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  std::array<std::byte, kBufferSize> buffer;
  std::uint64_t rest = part.size;
  std::uint64_t checksum = 0;
  while (file.is_open() && rest > 0) {
    const ssize_t count =
        ::read(file.get(), buffer.data(), std::min<std::uint64_t>(rest, buffer.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    checksum = crc64(std::span(buffer).first(static_cast<std::size_t>(count)), checksum);
    rest -= static_cast<std::uint64_t>(count);
  }
  return file.is_open() && checksum == part.checksum;
}

// Of what is open already, as "/dev/stdout": whatever it is, a file too, is written on from there.
std::optional<int> own_descriptor(const fs::path& target) {
  const std::string text = target.string();
  if (text == "/dev/stdout") return STDOUT_FILENO;
  if (text == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!text.starts_with(folder)) continue;
    int number = -1;
    const char* const end = text.data() + text.size();
    const auto [rest, failed] = std::from_chars(text.data() + folder.size(), end, number);
    if (failed == std::errc() && rest == end && number >= 0) return number;
  }
  return {};
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
  if (const std::optional<int> own = own_descriptor(target)) {
    file_ = FileDescriptor(::fcntl(*own, F_DUPFD_CLOEXEC, 0));
    if (!file_.is_open()) throw file_error("write", target_, errno);
    return;
  }
  std::error_code failed;
  final_ = fs::weakly_canonical(target, failed);
  if (failed || final_.empty()) final_ = target;
  struct stat info {};
  const bool exists = ::stat(final_.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode)) throw file_error("write", target_, EISDIR);
  if (exists && !S_ISREG(info.st_mode)) {
    file_ = FileDescriptor(::open(final_.c_str(), O_WRONLY | O_CLOEXEC));
    if (!file_.is_open()) throw file_error("write", target_, errno);
    return;
  }
  // A rename would also replace a file that was protected against writing.
  if (exists && ::access(final_.c_str(), W_OK) != 0) throw file_error("write", target_, errno);
  file_ = open_beside(final_, target_, temporary_);
  if (exists) ::fchmod(file_.get(), info.st_mode & 0777);
}

AtomicFile::AtomicFile(const fs::path& target, const Part& from)
    : target_(target), is_kept_(true), written_(from) {
  std::error_code failed;
  final_ = fs::weakly_canonical(target, failed);
  if (failed || final_.empty()) final_ = target;
  temporary_ = final_;
  temporary_ += ".part";
  if (from.size > 0 && !fs::exists(temporary_) && begins_with(final_, from))
    std::rename(final_.c_str(), temporary_.c_str());
  if (from.size > 0 && !begins_with(temporary_, from))
    throw ToolError({.message = fmt::format("'{}' does not begin with the {} bytes that were "
                                            "written before\nhelp: put the file back as it was, "
                                            "or begin the run anew",
                                            temporary_.string(), from.size)});
  file_ =
      FileDescriptor(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (!file_.is_open() || ::ftruncate(file_.get(), static_cast<off_t>(from.size)) != 0)
    throw file_error("write", temporary_, errno);
}

AtomicFile::~AtomicFile() { discard(); }

// Asks and writes nothing: a file that is made and removed again others would see.
void require_writable(const fs::path& target) {
  std::error_code failed;
  fs::path path = fs::weakly_canonical(fs::absolute(target), failed);
  if (failed || path.empty()) path = fs::absolute(target);
  struct stat info {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  if (own_descriptor(target) || (exists && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode)))
    return;
  if (exists && S_ISDIR(info.st_mode)) throw file_error("write", target, EISDIR);
  if (exists && ::access(path.c_str(), W_OK) != 0) throw file_error("write", target, errno);
  fs::path folder = path.parent_path();
  while (!fs::exists(folder, failed) && folder.has_relative_path()) folder = folder.parent_path();
  if (!fs::is_directory(folder, failed)) throw file_error("write", target, ENOTDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) throw file_error("write", target, errno);
}

void AtomicFile::discard() {
  file_.close();
  if (!temporary_.empty() && !is_kept_) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBufferSize) flush();
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = ::write(file_.get(), rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error_number = errno;
      buffer_.clear();
      discard();
      throw file_error("write", target_, error_number);
    }
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  if (is_kept_) {
    written_.size += buffer_.size();
    written_.checksum =
        crc64(std::as_bytes(std::span(buffer_.data(), buffer_.size())), written_.checksum);
  }
  buffer_.clear();
}

AtomicFile::Part AtomicFile::synced() {
  sync();
  return written_;
}

void AtomicFile::sync() {
  flush();
  // What is no ordinary file has no disk.
  if (::fsync(file_.get()) != 0 && errno != EINVAL && errno != EROFS) {
    const int error_number = errno;
    discard();
    throw file_error("write", target_, error_number);
  }
}

void AtomicFile::publish() {
  flush();
  if (file_.close() != 0) {
    const int error_number = errno;
    discard();
    throw file_error("write", target_, error_number);
  }
  if (temporary_.empty()) return;
  kill_point();
  if (std::rename(temporary_.c_str(), final_.c_str()) != 0) {
    const int error_number = errno;
    discard();
    throw file_error("write", target_, error_number);
  }
  temporary_.clear();
  kill_point();
}

void publish_file(const fs::path& aside, const fs::path& target) {
  FileDescriptor file(::open(aside.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open() || ::fsync(file.get()) != 0) throw file_error("write", target, errno);
  kill_point();
  if (std::rename(aside.c_str(), target.c_str()) != 0) throw file_error("write", target, errno);
  kill_point();
}

std::string read_file(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) throw file_error("read", path, errno);
  std::string text;
  std::array<char, kBufferSize> buffer;
  for (;;) {
    const ssize_t count = ::read(file.get(), buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw file_error("read", path, errno);
    if (count == 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

bool atomic_write(const fs::path& path, std::string_view text) {
  std::error_code failed;
  const fs::path parent = path.parent_path();
  if (!parent.empty()) {
    fs::create_directories(parent, failed);
    if (failed) throw file_error("create the directory", parent, failed.value());
  }
  if (fs::is_regular_file(path, failed) && fs::file_size(path, failed) == text.size() &&
      read_file(path) == text) {
    return false;
  }
  AtomicFile file(path);
  file.write(text);
  file.publish();
  return true;
}

}  // namespace hamgen::runtime
