#include "generator/base/pieces.hpp"

namespace hamgen {

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string_view> outermost_pieces(std::string_view text) {
  std::vector<std::string_view> pieces;
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(' || text[i] == '[') ++depth;
    if (text[i] == ')' || text[i] == ']') --depth;
    if (text[i] == ',' && depth == 0) {
      pieces.push_back(without_blanks(text.substr(begin, i - begin)));
      begin = i + 1;
    }
  }
  pieces.push_back(without_blanks(text.substr(begin)));
  return pieces;
}

}  // namespace hamgen
