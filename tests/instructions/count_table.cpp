#include "tests/instructions/count_table.hpp"

#include <fmt/format.h>

#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace hamgen::instructions {

CountTable read_table(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("no file " + path.string());
  CountTable table;
  std::string compiler;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    if (!line.starts_with(' ')) {
      compiler = line;
      continue;
    }
    std::istringstream words(line);
    double count = 0;
    std::string step;
    words >> count >> std::ws;
    std::getline(words, step);
    table[compiler][step] = count;
  }
  return table;
}

void write_table(const std::filesystem::path& path, const CountTable& table) {
  std::string text;
  {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line) && line.starts_with('#');) text += line + '\n';
  }
  for (const auto& [compiler, counts] : table) {
    text += '\n' + compiler + '\n';
    for (const auto& [step, count] : counts) text += fmt::format("{:9.0f}  {}\n", count, step);
  }
  std::ofstream(path) << text;
}

std::vector<std::string> differences(const Counts& counted, const Counts& expected) {
  std::set<std::string> names;
  for (const Counts* counts : {&counted, &expected}) {
    for (const auto& [name, count] : *counts) names.insert(name);
  }
  std::vector<std::string> found;
  for (const std::string& name : names) {
    if (!counted.contains(name) || !expected.contains(name)) {
      found.push_back(
          fmt::format("{}: {}", name, counted.contains(name) ? "has no row" : "is not counted"));
      continue;
    }
    const double now = counted.at(name);
    const double before = expected.at(name);
    if (now > 1.03 * before || now < before / 1.03) {
      found.push_back(fmt::format("{}: {:.0f} instructions a step instead of {:.0f}, {:+.1f} %",
                                  name, now, before, 100 * (now / before - 1)));
    }
  }
  return found;
}

}  // namespace hamgen::instructions
