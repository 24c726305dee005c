// What `hamgen run` hands out, read back.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hamgen::app_test {

// The object that `hamgen run ARGUMENTS --json` prints; expects the exit status.
[[nodiscard]] nlohmann::json run_json(std::vector<std::string> arguments, int status = 0);

struct Csv {
  std::vector<std::string> metadata;  // lines that begin with #
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};
[[nodiscard]] Csv read_csv(const std::string& text);

}  // namespace hamgen::app_test
