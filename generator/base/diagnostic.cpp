#include "generator/base/diagnostic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "generator/base/utf8.hpp"

namespace hamgen {
namespace {

constexpr std::size_t most_printed = 20;
constexpr std::size_t widest_line = 100;

// A line as one string per code point, so that it can be cut by columns.
std::vector<std::string> columns_of(std::string_view line) {
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < line.size();) {
    const std::optional<CodePoint> point = code_point_at(line, i);
    const std::size_t length = point ? point->length : 1;
    columns.push_back(printable(line.substr(i, length)));
    i += length;
  }
  return columns;
}

// The source line and the line of carets under [from, to), 0-based columns, cut to a window.
std::string excerpt(const std::vector<std::string>& columns, std::size_t line, std::size_t from,
                    std::size_t to) {
  std::size_t left = 0;
  std::size_t right = columns.size();
  if (columns.size() > widest_line) {
    left = from > widest_line / 2 ? from - widest_line / 2 : 0;
    right = std::min(columns.size(), left + widest_line);
  }
  std::string text = left > 0 ? "..." : "";
  const std::size_t indent = text.size() + from - left;
  for (std::size_t i = left; i < right; ++i) text += columns[i];
  if (right < columns.size()) text += "...";
  const std::size_t marked = std::max<std::size_t>(1, std::min(to, right) - std::min(from, right));
  const std::string number = fmt::format("{:>3}", line);
  return fmt::format("{} | {}\n{} | {}^{}\n", number, text, std::string(number.size(), ' '),
                     std::string(indent, ' '), std::string(marked - 1, '~'));
}

}  // namespace

std::string render(const Diagnostic& diagnostic, const SourceText& source) {
  const Position start = position(source, diagnostic.span.begin);
  const std::vector<std::string> columns = columns_of(line_text(source, diagnostic.span.begin));
  const std::size_t from = std::min(start.column - 1, columns.size());
  std::size_t to = columns.size();
  if (const Position end = position(source, diagnostic.span.end); end.line == start.line) {
    to = std::min(to, end.column - 1);
  }
  const char* severity = diagnostic.severity == Severity::error ? "error" : "warning";
  std::string text = fmt::format("{}:{}:{}: {}: {}\n", printable(source.path), start.line,
                                 start.column, severity, diagnostic.message);
  text += excerpt(columns, start.line, from, std::max(from, to));
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
    : diagnostics_(std::move(diagnostics)), text_(render(diagnostics_, source)) {}

void internal_error(std::string_view what, std::source_location where) {
  throw std::logic_error(
      fmt::format("hamgen is broken: {} ({}:{})", what, where.file_name(), where.line()));
}

}  // namespace hamgen
