// Files of records that are only ever appended to, so that a kill costs the last record at most.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "runtime/file_descriptor.hpp"

namespace hamgen::runtime {

// A record is a key and bytes, with a checksum over each.
struct PartRecord {
  std::uint64_t key = 0;
  std::uint64_t offset = 0;  // of its bytes in the file
  std::uint64_t size = 0;    // of its bytes
};

struct PartScan {
  std::vector<PartRecord> records;  // those that are whole, in the order they were written
  std::uint64_t end = 0;            // of the last record whose head is whole
  std::uint64_t spoilt = 0;         // records whose bytes are not what was written
};

// Reads and checks all of it.  What stands behind the first head that is not whole is no record.
// Throws ToolError.
[[nodiscard]] PartScan scan_part_file(const std::filesystem::path& path);

class PartFile {
 public:
  // Opens or makes it, and cuts off what is behind the last record.  Throws ToolError.
  explicit PartFile(const std::filesystem::path& path);

  // With one call of write(): a kill leaves the record whole, in part or not at all.  After a
  // ToolError (a full disk) the file ends with the record before.
  void append(std::uint64_t key, std::span<const std::byte> bytes);
  // Until it is on the disk.
  void sync() const;

 private:
  std::filesystem::path path_;
  FileDescriptor file_;
  std::uint64_t end_ = 0;
  std::vector<std::byte> buffer_;
};

// The bytes of a record; throws ToolError if the file is shorter by now.
class PartReader {
 public:
  explicit PartReader(const std::filesystem::path& path);
  void read(const PartRecord& record, std::vector<std::byte>& bytes) const;

 private:
  std::filesystem::path path_;
  FileDescriptor file_;
};

}  // namespace hamgen::runtime
