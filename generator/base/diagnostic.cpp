#include "generator/base/diagnostic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "generator/base/quoted_text.hpp"
#include "generator/base/utf8.hpp"

namespace hamgen {
namespace {

constexpr std::size_t most_printed = 20;
constexpr std::size_t widest_line = 100;

// Byte offsets of the code points of a line, and its length.
std::vector<std::size_t> columns_of(std::string_view line) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < line.size();) {
    columns.push_back(i);
    const std::optional<CodePoint> point = code_point_at(line, i);
    i += point ? point->length : 1;
  }
  columns.push_back(line.size());
  return columns;
}

// The line and a line of carets under [from, to), bytes of the line; long lines are cut.
std::string excerpt(std::string_view line, std::size_t number, std::size_t from, std::size_t to) {
  const std::vector<std::size_t> columns = columns_of(line);
  const auto column = [&](std::size_t byte) {
    return static_cast<std::size_t>(std::ranges::lower_bound(columns, byte) - columns.begin());
  };
  const std::size_t width = columns.size() - 1;
  const std::size_t first = column(from);
  std::size_t left = 0;
  std::size_t right = width;
  if (width > widest_line) {
    left = first > widest_line / 2 ? first - widest_line / 2 : 0;
    right = std::min(width, left + widest_line);
  }
  std::string text = left > 0 ? "..." : "";
  const std::size_t indent = text.size() + first - left;
  text += printable(line.substr(columns[left], columns[right] - columns[left]));
  if (right < width) text += "...";
  const std::size_t last = std::max(first + 1, std::min(column(to), right));
  const std::string shown = fmt::format("{:>3}", number);
  return fmt::format("{} |{}{}\n{} | {}^{}\n", shown, text.empty() ? "" : " ", text,
                     std::string(shown.size(), ' '), std::string(indent, ' '),
                     std::string(last - first - 1, '~'));
}

}  // namespace

std::string render(const Diagnostic& diagnostic, const SourceText& source) {
  const Position start = position(source, diagnostic.span.begin);
  const std::string_view line = line_text(source, diagnostic.span.begin);
  const std::size_t line_start = source.line_starts[start.line - 1];
  const std::size_t from = std::min(diagnostic.span.begin - line_start, line.size());
  const std::size_t to = std::min(diagnostic.span.end - line_start, line.size());
  const char* severity = diagnostic.severity == Severity::error ? "error" : "warning";
  std::string text = fmt::format("{}:{}:{}: {}: {}\n", visible_text(source.path), start.line,
                                 start.column, severity, diagnostic.message);
  text += excerpt(line, start.line, from, to);
  if (!diagnostic.help.empty()) text += fmt::format("help: {}\n", diagnostic.help);
  return text;
}

std::string render(const std::vector<Diagnostic>& diagnostics, const SourceText& source) {
  std::string text;
  const std::size_t printed = std::min(diagnostics.size(), most_printed);
  for (std::size_t i = 0; i < printed; ++i) text += render(diagnostics[i], source);
  if (printed < diagnostics.size()) {
    text += fmt::format("and {} more\n", diagnostics.size() - printed);
  }
  return text;
}

ModelError::ModelError(std::vector<Diagnostic> diagnostics, const SourceText& source)
    : diagnostics_(std::move(diagnostics)), text_(render(diagnostics_, source)) {
  for (const Diagnostic& diagnostic : diagnostics_)
    locations_.push_back(location_of(diagnostic, source));
}

Location location_of(const Diagnostic& diagnostic, const SourceText& source) {
  return {.file = source.path,
          .begin = position(source, diagnostic.span.begin),
          .end = position(source, std::max(diagnostic.span.begin, diagnostic.span.end))};
}

void internal_error(std::string_view what, std::source_location where) {
  const std::string_view path = where.file_name();
  throw std::logic_error(fmt::format("hamgen is broken: {} ({}:{})", what,
                                     path.substr(path.find_last_of('/') + 1), where.line()));
}

}  // namespace hamgen
