// The text a user wrote, with what is needed to point into it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hamgen {

// Half-open byte range [begin, end) of a SourceText.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool operator==(const Span&) const = default;
};

// 1-based line and column (a column counts code points, so that a caret lands under its letter).
struct Position {
  std::size_t line = 1;
  std::size_t column = 1;
};

struct SourceText {
  std::string path;                      // as the user named it
  std::string text;                      // without byte-order mark, line ends as written
  std::vector<std::size_t> line_starts;  // byte offset of every line
};

[[nodiscard]] SourceText make_source(std::string path, std::string text);
// The path of what came from standard input; a file of this name is "./stdin".
inline constexpr const char* kStandardInput = "stdin";
// Reads a file, or standard input for "-"; throws UsageError if it cannot be read, is a directory
// or is larger than 16 MB.
[[nodiscard]] SourceText read_source(const std::string& path);
[[nodiscard]] Position position(const SourceText& source, std::size_t offset);
// The line that holds the offset, without its line end.
[[nodiscard]] std::string_view line_text(const SourceText& source, std::size_t offset);

}  // namespace hamgen
