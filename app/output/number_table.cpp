#include "app/output/number_table.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>

#include "generator/base/diagnostic.hpp"
#include "generator/base/utf8.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

constexpr std::size_t kMostRows = 2000;
constexpr std::string_view kEnergyScale = "energy    scale ";

// Cells between commas; one in quotes may hold them, and "" is a quote there.
std::vector<std::string> cells(std::string_view line) {
  std::vector<std::string> result(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      const bool twice = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (twice) result.back() += line[++i];
      if (!twice) quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      result.emplace_back();
    } else {
      result.back() += line[i];
    }
  }
  return result;
}

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& path)
      : path_(path.string()), in_(path, std::ios::binary) {
    if (std::filesystem::is_directory(path))
      throw UsageError(fmt::format("cannot read '{}': it is a directory", path_));
    if (!in_) throw UsageError(fmt::format("cannot read '{}': {}", path_, std::strerror(errno)));
  }

  NumberTable run() {
    std::string status = "# status";
    bool is_made = false;
    bool is_ours = false;  // of `run`: it ends with its status
    for (std::string line; std::getline(in_, line);) {
      ++number_;
      if (in_.eof())
        fail("the last line has no end: the file is cut off",
             "draw it without that line: head -n -1 FILE > OTHER");
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (number_ == 1) line.erase(0, line.size() - without_byte_order_mark(line).size());
      is_made = is_made || line.starts_with("# made by   hamgen");
      is_ours = is_ours || (is_made && line.starts_with("step,t"));
      table_.is_whole = !is_ours || line.starts_with(status);
      if (line.starts_with("# ")) read_remark(std::string_view(line).substr(2));
      if (line.empty() || line.front() == '#') continue;
      if (table_.columns.empty()) {
        table_.columns = cells(line);
      } else {
        row(cells(line));
      }
    }
    if (table_.rows.empty())
      throw UsageError(fmt::format(
          "{}: no rows{}", path_, number_ == 0 ? ": the file is empty" : " under a line of names"));
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& help) const {
    throw UsageError(fmt::format("{}:{}: {}\nhelp: {}", path_, number_, what, help));
  }

  void read_remark(std::string_view remark) {
    if (!remark.starts_with(kEnergyScale)) return;
    remark.remove_prefix(kEnergyScale.size());
    double scale = 0.0;
    const auto end = std::from_chars(remark.data(), remark.data() + remark.size(), scale);
    if (end.ec == std::errc() && scale > 0.0) table_.energy_scale = scale;
  }

  void row(const std::vector<std::string>& texts) {
    if (texts.size() != table_.columns.size())
      fail(fmt::format("{} cells, where the line of names has {}", texts.size(),
                       table_.columns.size()),
           "a trajectory as `hamgen run -o FILE.csv` writes it is wanted, whole");
    std::vector<double> values;
    for (std::size_t i = 0; i < texts.size(); ++i) values.push_back(value(texts[i], i));
    table_.add(values);
  }

  double value(const std::string& text, std::size_t column) const {
    if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
    double result = 0.0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), result);
    if (end.ptr != text.data() + text.size() || end.ec == std::errc::invalid_argument)
      fail(
          fmt::format("'{}' in column {} is no number", text.substr(0, 30), table_.columns[column]),
          "a trajectory as `hamgen run -o FILE.csv` writes it is wanted");
    return result;
  }

  std::string path_;
  std::ifstream in_;
  long long number_ = 0;  // of the line
  NumberTable table_;
};

// By what is between two rows; what is not a number does not count.
void widen(std::vector<double>& low, std::vector<double>& high, const std::vector<double>& least,
           const std::vector<double>& greatest) {
  for (std::size_t i = 0; i < low.size(); ++i) {
    low[i] = std::fmin(low[i], least[i]);
    high[i] = std::fmax(high[i], greatest[i]);
  }
}

}  // namespace

void NumberTable::add(const std::vector<double>& row) {
  if (seen_++ % each != 0) {
    widen(low.back(), high.back(), row, row);
    return;
  }
  rows.push_back(row);
  low.push_back(row);
  high.push_back(row);
  if (rows.size() <= kMostRows) return;
  const std::size_t kept = (rows.size() + 1) / 2;
  for (std::size_t i = 0; i < kept; ++i) {
    const std::size_t from = 2 * i;
    if (from + 1 < rows.size()) widen(low[from], high[from], low[from + 1], high[from + 1]);
    if (i == 0) continue;
    rows[i] = std::move(rows[from]);
    low[i] = std::move(low[from]);
    high[i] = std::move(high[from]);
  }
  for (auto* const each_of : {&rows, &low, &high}) each_of->resize(kept);
  each *= 2;
}

std::string energy_scale_remark(double scale) {
  return std::string(kEnergyScale) + runtime::number_text(scale);
}

NumberTable read_number_table(const std::filesystem::path& path) { return TableReader(path).run(); }

}  // namespace hamgen::app
