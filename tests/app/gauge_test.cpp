// --gauge locally-exact on the command line: where it is taken, and its poles.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/run_results.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

const std::string kGaugedHarmonic = HAMGEN_SOURCE_DIR "/hamiltonians/harmonic.ham";
const std::string kGaugedKepler = HAMGEN_SOURCE_DIR "/hamiltonians/kepler.ham";
const std::string kStiff = HAMGEN_SOURCE_DIR "/hamiltonians/stiff_fpu.ham";

TEST(LocallyExactGauge, ARunTakesItAtItsOwnParameters) {
  // w = 1000 is the scene's, not the model's default: 100 steps of h w = 100.
  const json result = run_json({kGaugedHarmonic, "--gauge", "locally-exact", "--scene", "stiff",
                                "--h", "1/8", "--steps", "100"});
  // The phase of a step, 125, is rounded to 2^-53 of it, 100 times.
  EXPECT_NEAR(result["state"]["q"][0].get<double>(), std::cos(12500.0), 100 * 125 * 0x1p-52);
  // Unless it is told another place: then the oscillator is not solved exactly.
  const json elsewhere = run_json({kGaugedHarmonic, "--gauge", "locally-exact", "--reference",
                                   "w=990", "--scene", "stiff", "--h", "1/8", "--steps", "100"});
  EXPECT_GT(std::abs(elsewhere["state"]["q"][0].get<double>() - std::cos(12500.0)), 0.01);
}

TEST(LocallyExactGauge, AStepAtAPoleIsRefusedWithTheFrequency) {
  for (const char* h : {"2*pi", "-2*pi", "6.29", "20*pi"}) {
    const Result result =
        hamgen({"run", kGaugedHarmonic, "--gauge", "locally-exact", std::string("--h=") + h});
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_TRUE(contains(result.err, "the gauge has a pole at h = 6")) << result.err;
    EXPECT_TRUE(contains(result.err, "w = 1 of the linear part")) << result.err;
  }
  EXPECT_EQ(
      hamgen({"run", kGaugedHarmonic, "--gauge", "locally-exact", "--h", "6.31", "--steps", "10"})
          .status,
      0);
}

// All coordinates and momenta of stiff_fpu, w = 50, at t = 0, 0.01, ..., 20.
std::vector<std::vector<double>> chain_states(std::vector<std::string> method, int steps_a_row) {
  std::vector<std::string> arguments = {"run", kStiff, "-o", "-", "--quiet"};
  arguments.insert(arguments.end(), method.begin(), method.end());
  for (const std::string& text : {std::string("--h"), fmt::format("1/{}", 100 * steps_a_row),
                                  std::string("--steps"), fmt::format("{}", 2000 * steps_a_row),
                                  std::string("--every"), fmt::format("{}", steps_a_row)})
    arguments.push_back(text);
  const Result result = hamgen(arguments);
  EXPECT_EQ(result.status, 0) << result.err;
  std::vector<std::vector<double>> rows;
  std::istringstream lines(result.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || std::isdigit(static_cast<unsigned char>(line[0])) == 0) continue;
    std::istringstream fields(line);
    std::vector<double> values;
    for (std::string field; std::getline(fields, field, ',');) values.push_back(std::stod(field));
    rows.emplace_back(values.begin() + 2, values.begin() + 14);  // after step, t
  }
  return rows;
}

// The largest Euclidean distance in the rows so far.
std::vector<double> largest_errors(const std::vector<std::vector<double>>& rows,
                                   const std::vector<std::vector<double>>& exact) {
  std::vector<double> result;
  double largest = 0;
  for (std::size_t k = 0; k < std::min(rows.size(), exact.size()); ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < rows[k].size(); ++i) sum += std::pow(rows[k][i] - exact[k][i], 2);
    largest = std::max(largest, std::sqrt(sum));
    result.push_back(largest);
  }
  return result;
}

// h w = 0.125.  The largest error up to a time: at single times the fast phase may happen to fit.
TEST(LocallyExactGauge, TheStiffChainIsAThousandTimesMoreExactThanByTheMidpointRule) {
  const auto exact = chain_states({"--scheme", "gauss-12"}, 2);  // of 8 digits more
  ASSERT_EQ(exact.size(), 2001U);
  const auto midpoint = largest_errors(chain_states({}, 4), exact);
  const auto gauged = largest_errors(chain_states({"--gauge", "locally-exact"}, 4), exact);
  for (const std::size_t row : {25U, 100U, 200U, 500U, 1000U, 2000U})
    EXPECT_GT(midpoint[row], 1000 * gauged[row]) << "t = " << static_cast<double>(row) / 100;
  // At the origin too, from the second swing of the soft springs on.
  const auto at_origin =
      largest_errors(chain_states({"--gauge", "locally-exact", "--reference", "x[1]=0"}, 4), exact);
  for (const std::size_t row : {200U, 500U, 1000U, 2000U})
    EXPECT_GT(midpoint[row], 1000 * at_origin[row]) << "t = " << static_cast<double>(row) / 100;
}

TEST(LocallyExactGauge, ARunTakesItAtItsInitialStateUnlessAPointIsNamed) {
  const auto command = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", kStiff, "--gauge", "locally-exact", "--steps", "1"});
    return hamgen(more).err;
  };
  const std::string text = command({});
  for (const char* part : {"'x[1]=1'", "'y[1]=1/50'", "'px[1]=1'", "'py[1]=1'"})
    EXPECT_TRUE(contains(text, part)) << text;
  EXPECT_FALSE(contains(command({"--reference", "x[2]=0"}), "[1]=1")) << command({});
  // A parameter is no point.
  EXPECT_TRUE(contains(command({"--reference", "w=49"}), "'x[1]=1'"));
  // H'' of Kepler's problem is not defined at the origin.
  EXPECT_EQ(hamgen({"run", kGaugedKepler, "--gauge", "locally-exact", "--steps", "1"}).status, 0);
  EXPECT_EQ(
      hamgen({"generate", kGaugedKepler, "--gauge", "locally-exact", "--reference", "q1=0"}).status,
      2);
}

// The line of a log or a header that says which gauge it is.
std::string command_in(const std::string& text) {
  const std::size_t begin = text.find("--gauge locally-exact");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find('\n', begin) - begin);
}

TEST(LocallyExactGauge, IsTheSameInARunInGenerateAndInVerify) {
  const Scratch scratch;
  for (const auto& [model, scene] : {std::pair{kStiff, "w50"}, std::pair{kGaugedKepler, "e06"}}) {
    const Result result = hamgen({"run", model, "--gauge", "locally-exact", "--steps", "1",
                                  "--quiet", "--header", scratch.path("k")});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::string stem = std::filesystem::path(model).stem().string();
    const std::string header =
        hamgen({"generate", model, "--gauge", "locally-exact", "--scene", scene}).out;
    EXPECT_NE(command_in(header), "");
    EXPECT_EQ(command_in(read(scratch.path("k") + "/" + stem + ".hpp")), command_in(header));
    EXPECT_EQ(hamgen({"check", model, "--gauge", "locally-exact"}).status, 0);
  }
  // What is proved is the step of that scene: exact on the linear part where the scene starts.
  const Result proof = hamgen({"verify", kGaugedHarmonic, "--gauge", "locally-exact", "--scene",
                               "stiff", "--h", "1/800", "--json"});
  EXPECT_EQ(proof.status, 0) << proof.err;
  for (const json& row : json::parse(proof.out)) {
    // h w = 1000/800: the exact flow turns by that.
    if (row.contains("angles")) {
      EXPECT_NEAR(row.at("angles").at(0).get<double>(), 1.25, 1e-9);
    }
  }
}

TEST(LocallyExactGauge, AMistakeInTheReferenceIsCalledSo) {
  const Result result =
      hamgen({"generate", kGaugedHarmonic, "--gauge", "locally-exact", "--reference", "qq=1"});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "--reference:1:1: error: unknown name 'qq'")) << result.err;
  EXPECT_FALSE(contains(result.err, "--initial")) << result.err;
}

TEST(LocallyExactGauge, TheCommandInTheHeaderNamesTheReference) {
  const Result result =
      hamgen({"generate", kGaugedHarmonic, "--gauge", "locally-exact", "--reference", "w=3,q=1"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "--gauge locally-exact --reference w=3 --reference q=1\n"))
      << result.out.substr(0, 400);
}

}  // namespace
}  // namespace hamgen::app_test
