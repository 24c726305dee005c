#include "runtime/tool_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace hamgen::runtime {
namespace {

std::string full_text(const ToolFailure& failure) {
  std::string text = failure.message;
  if (!failure.command.empty()) text += fmt::format("\n  command: {}", failure.command);
  if (!failure.output_tail.empty()) text += fmt::format("\n  output:\n{}", failure.output_tail);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-_./=+,:@%").find(c) != std::string_view::npos;
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

// $'...' of POSIX.1-2024, bash, ksh and zsh: the one form that has no control character in it.
std::string quoted_controls(const std::string& word) {
  std::string text = "$'";
  for (const char c : word) {
    if (is_control(c)) {
      text += c == '\n' ? "\\n" : fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    } else {
      if (c == '\'' || c == '\\') text += '\\';
      text += c;
    }
  }
  return text + "'";
}

std::string quoted(const std::string& word) {
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  if (std::ranges::any_of(word, is_control)) return quoted_controls(word);
  std::string text = "'";
  for (const char c : word) {
    if (c == '\'') {
      text += "'\\''";
    } else {
      text += c;
    }
  }
  return text + "'";
}

}  // namespace

ToolError::ToolError(ToolFailure failure)
    : std::runtime_error(full_text(failure)), failure_(std::move(failure)) {}

ToolError file_error(std::string_view action, const std::filesystem::path& path, int error_number) {
  return ToolError({.message = fmt::format("cannot {} '{}': {}", action, path.string(),
                                           std::generic_category().message(error_number))});
}

std::string command_text(std::span<const std::string> command) {
  std::string text;
  for (const std::string& word : command) {
    if (!text.empty()) text += ' ';
    text += quoted(word);
  }
  return text;
}

std::string tail_of(std::string_view text, std::size_t max_lines, std::size_t max_bytes) {
  std::size_t start = text.size() > max_bytes ? text.size() - max_bytes : 0;
  if (start > 0) {
    const std::size_t line_end = text.find('\n', start);
    // One endless line is cut in its middle rather than lost.
    if (line_end != std::string_view::npos && line_end + 1 < text.size()) start = line_end + 1;
  }
  std::string_view tail = text.substr(start);
  std::size_t lines = 0;
  for (std::size_t i = tail.size(); i > 0; --i) {
    if (tail[i - 1] != '\n' || i == tail.size()) continue;
    if (++lines == max_lines) {
      tail.remove_prefix(i);
      break;
    }
  }
  return std::string(tail);
}

}  // namespace hamgen::runtime
