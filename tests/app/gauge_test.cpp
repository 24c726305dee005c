// --gauge locally-exact on the command line: where it is taken, and its poles.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

const std::string kHarmonic = HAMGEN_SOURCE_DIR "/hamiltonians/harmonic.ham";
const std::string kStiff = HAMGEN_SOURCE_DIR "/hamiltonians/stiff_fpu.ham";

json run_json(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "run");
  arguments.insert(arguments.end(), {"--json", "--quiet"});
  const Result result = hamgen(arguments);
  EXPECT_EQ(result.status, 0) << result.err;
  return json::parse(result.out);
}

TEST(LocallyExactGauge, ARunTakesItAtItsOwnParameters) {
  // w = 1000 is the scene's, not the model's default: 100 steps of h w = 100.
  const json result = run_json(
      {kHarmonic, "--gauge", "locally-exact", "--scene", "stiff", "--h", "1/8", "--steps", "100"});
  // The phase of a step, 125, is rounded to 2^-53 of it, 100 times.
  EXPECT_NEAR(result["state"]["q"][0].get<double>(), std::cos(12500.0), 100 * 125 * 0x1p-52);
  // Unless it is told another place: then the oscillator is not solved exactly.
  const json elsewhere = run_json({kHarmonic, "--gauge", "locally-exact", "--reference", "w=990",
                                   "--scene", "stiff", "--h", "1/8", "--steps", "100"});
  EXPECT_GT(std::abs(elsewhere["state"]["q"][0].get<double>() - std::cos(12500.0)), 0.01);
}

TEST(LocallyExactGauge, AStepAtAPoleIsRefusedWithTheFrequency) {
  for (const char* h : {"2*pi", "-2*pi", "6.29", "20*pi"}) {
    const Result result =
        hamgen({"run", kHarmonic, "--gauge", "locally-exact", std::string("--h=") + h});
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_TRUE(contains(result.err, "the gauge has a pole at h = 6")) << result.err;
    EXPECT_TRUE(contains(result.err, "w = 1 of the linear part")) << result.err;
  }
  EXPECT_EQ(
      hamgen({"run", kHarmonic, "--gauge", "locally-exact", "--h", "6.31", "--steps", "10"}).status,
      0);
}

TEST(LocallyExactGauge, TheStiffChainIsAThousandTimesMoreExactThanByTheMidpointRule) {
  // h w = 0.125, t = 5.  The reference is the same member with a step 64 times smaller: its error
  // is 4096 times smaller than the one that is measured.
  const auto at_the_end = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), kStiff);
    const json state = run_json(arguments)["state"];
    std::vector<double> z = state["q"];
    for (const json& p : state["p"]) z.push_back(p);
    return z;
  };
  const auto distance = [](const std::vector<double>& x, const std::vector<double>& y) {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
    return std::sqrt(sum);
  };
  const std::vector<double> exact =
      at_the_end({"--gauge", "locally-exact", "--h", "1/25600", "--steps", "128000"});
  const double midpoint = distance(at_the_end({"--h", "1/400", "--steps", "2000"}), exact);
  const double gauged =
      distance(at_the_end({"--gauge", "locally-exact", "--h", "1/400", "--steps", "2000"}), exact);
  EXPECT_GT(midpoint, 1000 * gauged) << midpoint << " " << gauged;
}

TEST(LocallyExactGauge, TheCommandInTheHeaderNamesTheReference) {
  const Result result =
      hamgen({"generate", kHarmonic, "--gauge", "locally-exact", "--reference", "w=3,q=1"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "--gauge locally-exact --reference w=3 --reference q=1\n"))
      << result.out.substr(0, 400);
}

}  // namespace
}  // namespace hamgen::app_test
