#include "app/studies/ensemble_plan.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>

#include "app/studies/philox.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/pieces.hpp"
#include "generator/base/utf8.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/csv_writer.hpp"
#include "runtime/sha256.hpp"

namespace hamgen::app {
namespace {

double on_axis(const EnsembleAxis& axis, long long i) {
  if (i == 0) return axis.low;
  if (i == axis.count - 1) return axis.high;
  return axis.low +
         (axis.high - axis.low) * static_cast<double>(i) / static_cast<double>(axis.count - 1);
}

// By Box and Muller (1958) if it is normal.
double drawn(const EnsembleDraw& draw, std::uint64_t seed, long long index, std::size_t sequence) {
  const auto [u, v] =
      uniform_pair(seed, static_cast<std::uint64_t>(index), static_cast<std::uint32_t>(sequence));
  if (draw.distribution == Distribution::uniform) return draw.a + (draw.b - draw.a) * u;
  return draw.a + draw.b * std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

std::string distribution_text(const EnsembleDraw& draw) {
  return fmt::format("{}({},{})", draw.distribution == Distribution::uniform ? "uniform" : "normal",
                     runtime::number_text(draw.a), runtime::number_text(draw.b));
}

std::string_view unquoted(std::string_view cell) {
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
    cell = cell.substr(1, cell.size() - 2);
  return without_blanks(cell);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    cells.push_back(unquoted(without_blanks(line.substr(begin, i - begin))));
    begin = i + 1;
  }
  return cells;
}

double number_of(std::string_view cell, const std::string& where) {
  double value = 0.0;
  const char* first = cell.data() + (cell.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(first, cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
    throw UsageError(fmt::format("{}: '{}' is no finite number", where, cell.substr(0, 40)));
  return value;
}

}  // namespace

std::vector<std::string> EnsemblePlan::names() const {
  std::vector<std::string> all = table.names;
  for (const EnsembleAxis& axis : axes) all.push_back(axis.name);
  for (const EnsembleDraw& draw : draws) all.push_back(draw.name);
  return all;
}

double EnsemblePlan::size() const {
  double all = static_cast<double>(table.rows()) * static_cast<double>(draws_each);
  for (const EnsembleAxis& axis : axes) all *= static_cast<double>(axis.count);
  return all;
}

void EnsemblePlan::values(long long index, std::span<double> values) const {
  long long rest = index / draws_each;
  std::size_t k = table.names.size();
  for (const EnsembleAxis& axis : axes) {
    values[k++] = on_axis(axis, rest % axis.count);
    rest /= axis.count;
  }
  for (std::size_t i = 0; i < table.names.size(); ++i)
    values[i] = table.values[static_cast<std::size_t>(rest) * table.names.size() + i];
  for (std::size_t i = 0; i < draws.size(); ++i) values[k++] = drawn(draws[i], seed, index, i);
}

std::vector<std::string> EnsemblePlan::to_text() const {
  std::vector<std::string> lines;
  if (!table.names.empty())
    lines.push_back(fmt::format("from      {} rows of {}   sha256 {}", table.rows(),
                                fmt::join(table.names, ", "), table.digest));
  for (const EnsembleAxis& axis : axes)
    lines.push_back(fmt::format("over      {}={}:{}:{}", axis.name, runtime::number_text(axis.low),
                                runtime::number_text(axis.high), axis.count));
  for (const EnsembleDraw& draw : draws)
    lines.push_back(fmt::format("random    {}={}", draw.name, distribution_text(draw)));
  if (!draws.empty()) lines.push_back(fmt::format("draws     {}, seed {}", draws_each, seed));
  return lines;
}

EnsembleTable read_ensemble_table(const std::string& path) {
  const std::string text = runtime::read_file(path);
  EnsembleTable table{.path = path, .digest = runtime::sha256_hex(text), .names = {}, .values = {}};
  std::size_t line_number = 0;
  for (std::size_t begin = text.size() - without_byte_order_mark(text).size();
       begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = without_blanks(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    ++line_number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    const std::string where = fmt::format("{}:{}", path, line_number);
    const std::vector<std::string_view> cells = cells_of(line);
    if (table.names.empty()) {
      table.names.assign(cells.begin(), cells.end());
      continue;
    }
    if (cells.size() != table.names.size())
      throw UsageError(
          fmt::format("{}: {} cells for {} names", where, cells.size(), table.names.size()));
    for (const std::string_view cell : cells) table.values.push_back(number_of(cell, where));
  }
  if (table.values.empty())
    throw UsageError(fmt::format(
        "--from {}: there are no rows\nhelp: a line of names, then one of numbers for each "
        "trajectory:\n  q1,p1\n  0.1,0.2",
        path));
  return table;
}

}  // namespace hamgen::app
