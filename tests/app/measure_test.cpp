// hamgen verify --measure: the compiled step's own tangent map.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

struct Measured {
  std::string verdict;
  double most = -1;  // of M^T J M - J over the states
  int status = -1;
};

Measured measured(const std::string& model, std::vector<std::string> options) {
  options.insert(options.begin(),
                 {"verify", HAMGEN_SOURCE_DIR "/hamiltonians/" + model, "--measure", "--json"});
  const Result result = hamgen(options);
  Measured found{.status = result.status};
  for (const auto& finding : nlohmann::json::parse(result.out)) {
    if (finding["property"] != "tangent map symplectic") continue;
    found.verdict = finding["verdict"];
    const std::string detail = finding["detail"];
    found.most = std::strtod(detail.c_str() + detail.find("at most ") + 8, nullptr);
  }
  return found;
}

TEST(Measure, FindsSymplecticMembersSymplecticToRoundOff) {
  for (const auto& [model, options] :
       {std::pair<std::string, std::vector<std::string>>{"pendulum.ham", {}},
        {"henon_heiles.ham", {"--alpha", "3/10", "--beta", "h/7", "--gamma=-h/9"}},
        {"double_pendulum.ham", {}},
        {"kepler.ham", {"--scheme", "symplectic-euler-a"}}}) {
    const Measured found = measured(model, options);
    EXPECT_EQ(found.verdict, "tested") << model;
    EXPECT_GE(found.most, 0) << model;
    EXPECT_LE(found.most, 1e-13) << model;
  }
}

TEST(Measure, FindsTheDefectOfSweepsAndThatItFallsWithTheirNumber) {
  // Two sweeps more multiply the defect by about h^2 H'' T'' = 0.01 * 0.03.
  double before = 1e-5;
  for (const char* sweeps : {"sweeps:1", "sweeps:3", "sweeps:5"}) {
    const Measured found = measured("pendulum.ham", {"--solver", sweeps});
    if (found.most > 1e-13) {
      EXPECT_EQ(found.verdict, "refuted") << sweeps;
      EXPECT_EQ(found.status, 5) << sweeps;
    }
    EXPECT_LT(found.most, before / 100) << sweeps;
    before = found.most;
  }
  EXPECT_GT(measured("pendulum.ham", {"--solver", "sweeps:2"}).most, 1e-9);
}

}  // namespace
}  // namespace hamgen::app_test
