#include "runtime/object_file.hpp"

#include <elf.h>
#include <link.h>

#include <cstring>
#include <string_view>
#include <type_traits>

#include "runtime/atomic_file.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

using FileHeader = ElfW(Ehdr);
using Segment = ElfW(Phdr);

// Is [offset, offset + size) inside?
bool holds(std::string_view file, std::uint64_t offset, std::uint64_t size) {
  return offset <= file.size() && size <= file.size() - offset;
}

template <typename Table>
Table read_at(std::string_view file, std::uint64_t offset) {
  static_assert(std::is_trivially_copyable_v<Table>);
  Table table;
  std::memcpy(&table, file.data() + offset, sizeof table);
  return table;
}

std::string problem_of(std::string_view file) {
  const std::string cut = "it is cut off";
  if (!holds(file, 0, sizeof(FileHeader))) return cut;
  const auto header = read_at<FileHeader>(file, 0);
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_type != ET_DYN ||
      header.e_phentsize != sizeof(Segment))
    return "it is no shared object";
  if (!holds(file, header.e_phoff, std::uint64_t{header.e_phnum} * sizeof(Segment)) ||
      !holds(file, header.e_shoff, std::uint64_t{header.e_shnum} * header.e_shentsize))
    return cut;
  for (unsigned i = 0; i < header.e_phnum; ++i) {
    const auto segment = read_at<Segment>(file, header.e_phoff + i * sizeof(Segment));
    if (!holds(file, segment.p_offset, segment.p_filesz)) return cut;
  }
  return {};
}

}  // namespace

std::string object_problem(const std::filesystem::path& object) {
  try {
    return problem_of(read_file(object));
  } catch (const ToolError& error) {
    return error.failure().message;
  }
}

}  // namespace hamgen::runtime
