#include "app/output/summary_entry.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hamgen::app {
namespace {

// The next space at which a line may end.
std::size_t piece_end(const std::string& text, std::size_t begin) {
  std::size_t end = text.find(' ', begin);
  while (end != std::string::npos &&
         (text.compare(end, 3, " = ") == 0 || (end > 1 && text.compare(end - 2, 3, " = ") == 0)))
    end = text.find(' ', end + 1);
  return std::min(end, text.size());
}

}  // namespace

std::string summary_entry(std::string_view label, const std::string& text) {
  constexpr std::size_t indent = 14;
  std::string result = fmt::format("  {:<{}}", label, indent - 2);
  std::size_t column = indent;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = piece_end(text, begin);
    const std::string piece = text.substr(begin, end - begin);
    if (column > indent && column + 1 + piece.size() > summary_width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      result += ' ';
      ++column;
    }
    result += piece;
    column += piece.size();
    begin = end + 1;
  }
  return result + "\n";
}

}  // namespace hamgen::app
