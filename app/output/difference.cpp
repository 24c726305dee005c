#include "app/output/difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace hamgen::app {
namespace {

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return lines;
}

}  // namespace

std::string difference(std::string_view old_name, std::string_view old_text,
                       std::string_view new_name, std::string_view new_text,
                       std::size_t max_lines) {
  if (old_text == new_text) return "";
  constexpr std::size_t context = 3;
  const auto before = lines_of(old_text);
  const auto after = lines_of(new_text);
  const std::size_t shorter = std::min(before.size(), after.size());
  std::size_t head = 0;
  while (head < shorter && before[head] == after[head]) ++head;
  std::size_t tail = 0;
  while (tail < shorter - head &&
         before[before.size() - 1 - tail] == after[after.size() - 1 - tail])
    ++tail;

  const std::size_t begin = head - std::min(head, context);
  const std::size_t rest = tail - std::min(tail, context);
  std::vector<std::string> body;
  const auto add = [&body](char mark, std::string_view line) {
    std::string text = fmt::format("{}{}", mark, line);
    if (!text.ends_with('\n')) text += "\n\\ No newline at end of file\n";
    body.push_back(std::move(text));
  };
  for (std::size_t i = begin; i < head; ++i) add(' ', before[i]);
  for (std::size_t i = head; i < before.size() - tail; ++i) add('-', before[i]);
  for (std::size_t i = head; i < after.size() - tail; ++i) add('+', after[i]);
  for (std::size_t i = before.size() - tail; i < before.size() - rest; ++i) add(' ', before[i]);

  const std::size_t shown = std::min(body.size(), max_lines);
  std::string text =
      fmt::format("--- {}\n+++ {}\n@@ -{},{} +{},{} @@\n", old_name, new_name, begin + 1,
                  before.size() - rest - begin, begin + 1, after.size() - rest - begin);
  for (std::size_t i = 0; i < shown; ++i) text += body[i];
  if (shown < body.size()) text += fmt::format("... and {} more lines\n", body.size() - shown);
  return text;
}

}  // namespace hamgen::app
