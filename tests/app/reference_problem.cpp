#include "tests/app/reference_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

// Two units of the last digit that is printed.
long double resolution(const std::string& digits) {
  const std::size_t point = digits.find('.');
  return 2 * std::pow(10.0L, -static_cast<long double>(digits.size() - 1 - point));
}

}  // namespace

void expect_reference(const Problem& problem) {
  const Scratch scratch;
  const std::string text = problem.model;
  const std::string path = text.find('\n') == std::string::npos
                               ? HAMGEN_SOURCE_DIR "/hamiltonians/" + text + ".ham"
                               : scratch.write("m.ham", text);
  std::vector<std::string> words = {"bench",     path,
                                    "--time",    problem.time,
                                    "--h",       std::string(problem.time) + "/1000",
                                    "--schemes", "symplectic-euler-a",
                                    "--rounds",  "1",
                                    "--json",    "--quiet"};
  words.insert(words.end(), problem.options.begin(), problem.options.end());
  const Result result = hamgen(words);
  ASSERT_EQ(result.status, 0) << problem.name << ": " << result.err;
  const json reference = json::parse(result.out)["reference"];
  ASSERT_TRUE(reference.contains("state")) << problem.name << ": " << reference;
  const double own_error = reference["error"];
  EXPECT_LT(own_error, 1e-17) << problem.name;
  std::printf("%-24s own error %.1e, %.2f s\n", problem.name, own_error,
              reference["seconds"].get<double>());
  for (const Expected& expected : problem.expected) {
    const json& pair = reference["state"][expected.place];
    const long double wanted = std::strtold(expected.value, nullptr);
    const long double difference =
        (pair[0].get<long double>() - wanted) + pair[1].get<long double>();
    const long double bound =
        expected.tolerance > 0 ? expected.tolerance : resolution(expected.value);
    EXPECT_LE(std::fabs(difference), bound + 10 * own_error)
        << problem.name << ", component " << expected.place;
  }
}

void expect_references(const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) expect_reference(problem);
}

}  // namespace hamgen::app_test
