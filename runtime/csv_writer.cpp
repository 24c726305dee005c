#include "runtime/csv_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace hamgen::runtime {
namespace {

template <typename Number>
void append_number(std::string& text, Number value) {
  std::array<char, 32> digits;
  const std::to_chars_result end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end.ptr);
}

// One metadata line for each line of the text: a line break in a model's name must not make a row.
void append_remark(std::string& text, std::string_view remark) {
  text += "# ";
  for (const char c : remark) {
    if (c == '\n') {
      text += "\n# ";
    } else if (c != '\r') {
      text += c;
    }
  }
  text += '\n';
}

}  // namespace

std::string number_text(double value) {
  std::string text;
  if (std::isfinite(value)) append_number(text, value);
  return text;
}

CsvWriter::CsvWriter(const std::filesystem::path& target, std::span<const std::string> metadata,
                     std::span<const std::string> columns)
    : file_(target), columns_(columns.size()) {
  write_head(metadata, columns);
}

CsvWriter::CsvWriter(const std::filesystem::path& target, std::span<const std::string> metadata,
                     std::span<const std::string> columns, const AtomicFile::Part& from)
    : file_(target, from), columns_(columns.size()) {
  if (from.size == 0) write_head(metadata, columns);
}

void CsvWriter::write_head(std::span<const std::string> metadata,
                           std::span<const std::string> columns) {
  if (columns.empty()) throw std::invalid_argument("a table needs a column for the step");
  for (const std::string& remark : metadata) append_remark(line_, remark);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) line_ += ',';
    line_ += csv_cell(columns[i]);
  }
  line_ += '\n';
  file_.write(line_);
}

void CsvWriter::write_row(long long step, std::span<const double> values) {
  if (values.size() + 1 != columns_) {
    throw std::invalid_argument(
        fmt::format("a row of {} values for {} columns", values.size() + 1, columns_));
  }
  line_.clear();
  append_number(line_, step);
  for (const double value : values) {
    line_ += ',';
    if (std::isfinite(value)) append_number(line_, value);
  }
  line_ += '\n';
  file_.write(line_);
  ++rows_;
}

void CsvWriter::publish(std::string_view last_remark) {
  if (!last_remark.empty()) {
    line_.clear();
    append_remark(line_, last_remark);
    file_.write(line_);
  }
  file_.publish();
}

std::string csv_cell(std::string text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
    text.insert(at, 1, '"');
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return '"' + text + '"';
}

}  // namespace hamgen::runtime
