#include "generator/base/source_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "generator/base/utf8.hpp"

namespace hamgen {
namespace {

constexpr std::size_t largest_file = std::size_t{16} << 20U;

// Index of the line that holds the offset.
std::size_t line_index(const SourceText& source, std::size_t offset) {
  const auto after = std::upper_bound(source.line_starts.begin(), source.line_starts.end(), offset);
  return static_cast<std::size_t>(after - source.line_starts.begin()) - 1;
}

}  // namespace

SourceText make_source(std::string path, std::string text) {
  text.erase(0, text.size() - without_byte_order_mark(text).size());
  SourceText source{.path = std::move(path), .text = std::move(text), .line_starts = {0}};
  for (std::size_t i = 0; i < source.text.size(); ++i) {
    if (source.text[i] == '\n') source.line_starts.push_back(i + 1);
  }
  return source;
}

SourceText read_source(const std::string& name) {
  const std::string path = name == "-" ? "/dev/stdin" : name;
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw UsageError(fmt::format("cannot read '{}': it is a directory", visible_text(path)));
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw UsageError(fmt::format("cannot read '{}': {}", visible_text(path), std::strerror(errno)));
  }
  // Read in pieces: a pipe or a device has no size to ask for.
  std::string text;
  std::string piece(std::size_t{1} << 16U, '\0');
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
    text.append(piece, 0, static_cast<std::size_t>(file.gcount()));
    if (text.size() > largest_file) {
      throw UsageError(
          fmt::format("cannot read '{}': it is larger than 16 MB", visible_text(path)));
    }
  }
  if (name == "-") return make_source(kStandardInput, std::move(text));
  return make_source(name == kStandardInput ? "./" + name : path, std::move(text));
}

Position position(const SourceText& source, std::size_t offset) {
  offset = std::min(offset, source.text.size());
  const std::size_t line = line_index(source, offset);
  std::size_t column = 1;
  for (std::size_t i = source.line_starts[line]; i < offset; ++column) {
    const std::optional<CodePoint> point = code_point_at(source.text, i);
    i += point ? point->length : 1;
  }
  return {.line = line + 1, .column = column};
}

std::string_view line_text(const SourceText& source, std::size_t offset) {
  const std::size_t line = line_index(source, std::min(offset, source.text.size()));
  const std::size_t begin = source.line_starts[line];
  std::string_view text(source.text);
  text = text.substr(begin, text.find('\n', begin) - begin);
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

}  // namespace hamgen
