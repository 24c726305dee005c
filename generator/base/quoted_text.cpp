#include "generator/base/quoted_text.hpp"

#include <fmt/format.h>

#include "generator/base/utf8.hpp"

namespace hamgen {
namespace {

// The text with control characters and illegal bytes replaced, but for those of `kept`.
std::string visible(std::string_view text, std::string_view kept) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::optional<CodePoint> point = code_point_at(text, i);
    const std::size_t length = point ? point->length : 1;
    if (!point) {
      result += fmt::format("<0x{:02X}>", static_cast<unsigned char>(text[i]));
    } else if (is_control(point->value) && kept.find(text[i]) == std::string_view::npos) {
      result += fmt::format("<U+{:04X}>", static_cast<std::uint32_t>(point->value));
    } else {
      result += text.substr(i, length);
    }
    i += length;
  }
  return result;
}

// Three octal digits: no digit after them can be taken for a fourth.
std::string octal(char c) { return fmt::format("\\{:03o}", static_cast<unsigned char>(c)); }

}  // namespace

std::string visible_lines(std::string_view text) { return visible(text, "\n\t"); }

std::string visible_text(std::string_view text) { return visible(text, "\t"); }

std::string comment_text(std::string_view text) {
  std::string result = visible_text(text);
  // ??/ is a backslash to compilers that still know trigraphs.
  const std::string_view end =
      std::string_view(result).substr(0, result.find_last_not_of(" \t") + 1);
  return end.ends_with('\\') || end.ends_with("?\?/") ? result + "." : result;
}

std::string cpp_string(std::string_view text) {
  const bool plain = visible(text, "") == text;
  std::string result = "\"";
  for (const char c : text) {
    const bool ascii = c >= ' ' && c <= '~';
    const bool trigraph = c == '?' && result.ends_with('?');
    if (c == '"' || c == '\\' || trigraph) result += '\\';
    result += ascii || plain ? std::string(1, c) : octal(c);
  }
  return result + '"';
}

std::string html_text(std::string_view text) {
  std::string result;
  for (const char c : visible_lines(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string gnuplot_text(std::string_view text) {
  std::string result = "'";
  for (const char c : visible_text(text)) {
    if (c == '\'') result += c;
    result += c;
  }
  return result + "'";
}

std::string gnuplot_path(std::string_view path) {
  if (visible_text(path) == path) return gnuplot_text(path);
  std::string result = "\"";
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '/';
    result += plain ? std::string(1, c) : octal(c);
  }
  return result + "\"";
}

}  // namespace hamgen
