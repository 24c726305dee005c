#include "tests/app/run_results.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {

nlohmann::json run_json(std::vector<std::string> arguments, int status) {
  arguments.insert(arguments.begin(), "run");
  arguments.insert(arguments.end(), {"--json", "--quiet"});
  const Result result = hamgen(arguments);
  EXPECT_EQ(result.status, status) << result.err;
  return nlohmann::json::parse(result.out);
}

Csv read_csv(const std::string& text) {
  Csv csv;
  for (const std::string& line : lines(text)) {
    if (line.starts_with("#")) {
      csv.metadata.push_back(line);
      continue;
    }
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    }
    if (csv.columns.empty()) {
      csv.columns = cells;
      continue;
    }
    csv.rows.emplace_back();
    for (const std::string& cell : cells)
      csv.rows.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  return csv;
}

}  // namespace hamgen::app_test
