#include "runtime/part_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "runtime/crc64.hpp"
#include "runtime/kill_point.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;

// Before a record's bytes; in the order of bytes of the machine, where another one finds no record.
struct PartHead {
  std::uint64_t magic = 0x31747261706d6168;  // "hampart1"
  std::uint64_t key = 0;
  std::uint64_t size = 0;
  std::uint64_t checksum = 0;  // of the bytes
  std::uint64_t own = 0;       // of the fields above
};
static_assert(sizeof(PartHead) == 40);

std::uint64_t own_checksum(const PartHead& head) {
  return crc64(std::as_bytes(std::span(&head, 1)).first(offsetof(PartHead, own)));
}

// As many bytes as there are, up to `size`.
std::size_t read_at(int file, const fs::path& path, std::uint64_t offset, std::byte* to,
                    std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = ::pread(file, to + done, size - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw file_error("read", path, errno);
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

void write_all(int file, const fs::path& path, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw file_error("write", path, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

std::uint64_t size_of_file(int file, const fs::path& path) {
  struct stat info {};
  if (::fstat(file, &info) != 0) throw file_error("read", path, errno);
  return static_cast<std::uint64_t>(info.st_size);
}

PartScan scan(int file, const fs::path& path) {
  PartScan result;
  const std::uint64_t all = size_of_file(file, path);
  std::vector<std::byte> bytes;
  for (;;) {
    PartHead head;
    const std::size_t got = read_at(
        file, path, result.end, std::as_writable_bytes(std::span(&head, 1)).data(), sizeof head);
    if (got < sizeof head || head.magic != PartHead{}.magic || head.own != own_checksum(head) ||
        head.size > all - result.end - sizeof head)
      return result;
    const std::uint64_t offset = result.end + sizeof head;
    bytes.resize(head.size);
    if (read_at(file, path, offset, bytes.data(), head.size) < head.size) return result;
    if (crc64(bytes) == head.checksum) {
      result.records.push_back({.key = head.key, .offset = offset, .size = head.size});
    } else {
      ++result.spoilt;
    }
    result.end = offset + head.size;
  }
}

}  // namespace

PartScan scan_part_file(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) throw file_error("read", path, errno);
  return scan(file.get(), path);
}

PartFile::PartFile(const fs::path& path)
    : path_(path), file_(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
  if (!file_.is_open()) throw file_error("write", path, errno);
  end_ = scan(file_.get(), path).end;
  if (::ftruncate(file_.get(), static_cast<off_t>(end_)) != 0)
    throw file_error("write", path, errno);
}

void PartFile::append(std::uint64_t key, std::span<const std::byte> bytes) {
  PartHead head{.key = key, .size = bytes.size(), .checksum = crc64(bytes)};
  head.own = own_checksum(head);
  buffer_.resize(sizeof head + bytes.size());
  std::memcpy(buffer_.data(), &head, sizeof head);
  if (!bytes.empty()) std::memcpy(buffer_.data() + sizeof head, bytes.data(), bytes.size());
  try {
    std::span<const std::byte> all = buffer_;
    if (has_kill_points()) {
      const std::size_t half = all.size() / 2;
      write_all(file_.get(), path_, all.first(half));
      kill_point();
      all = all.subspan(half);
    }
    write_all(file_.get(), path_, all);
  } catch (const ToolError&) {
    // What is left of it is found out by its checksum, if this fails too.
    static_cast<void>(::ftruncate(file_.get(), static_cast<off_t>(end_)));
    throw;
  }
  end_ += buffer_.size();
}

void PartFile::sync() const {
  if (::fdatasync(file_.get()) != 0) throw file_error("write", path_, errno);
}

PartReader::PartReader(const fs::path& path)
    : path_(path), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (!file_.is_open()) throw file_error("read", path, errno);
}

void PartReader::read(const PartRecord& record, std::vector<std::byte>& bytes) const {
  bytes.resize(record.size);
  if (read_at(file_.get(), path_, record.offset, bytes.data(), bytes.size()) < bytes.size())
    throw ToolError(
        {.message = fmt::format("'{}' is shorter than it was a moment ago", path_.string())});
}

}  // namespace hamgen::runtime
