// What a run says of a wider scalar has that scalar's digits.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "app/output/wide_text.hpp"
#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;
using Quad = long double;  // 64 bits tell 106 bits from 53

const std::string kKepler = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/kepler.ham";

Result kepler(std::vector<std::string> options) {
  std::vector<std::string> arguments = {"run",      kKepler,   "--interpret", "--scheme",
                                        "gauss-16", "--steps", "20"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return hamgen(arguments);
}

// The error of gauss-16, (h/2)^16 of some 20 at the pericentre's rate, is below the rounding, 1e-34
// a step: 106 of quad's 113 bits are 1e-32 of the numbers, which are below 2.
TEST(WideNumbers, EnergyAndInvariantsAreTheScalars) {
  const json result = json::parse(kepler({"--scalar", "quad", "--h", "1e-3", "--json"}).out);
  EXPECT_GT(result["energy"]["max_error"].get<double>(), 0.0);
  EXPECT_LT(result["energy"]["max_error"].get<double>(), 1e-31);
  EXPECT_LT(result["energy"]["spread"].get<double>(), 1e-31);
  // H = -1/2 exactly at the scene's start, of which 2/5 has 106 bits.
  EXPECT_LT(std::abs(result["energy"]["initial_lo"].get<double>()), 1e-31);
  for (const std::string name : {"L", "A1", "A2"})
    EXPECT_LT(std::abs(result["invariants"][name]["final_error"].get<double>()), 1e-31) << name;
  // 4/5 is no double: the rest is said.
  EXPECT_NEAR(result["invariants"]["L"]["final_lo"].get<double>(), -4.440892098500626e-17, 1e-31);
}

TEST(WideNumbers, DoubleStaysWhatItIs) {
  const std::string in_double = kepler({"--json"}).out;
  EXPECT_FALSE(contains(in_double, "_lo"));
  EXPECT_GT(json::parse(in_double)["energy"]["max_error"].get<double>(), 1e-17);
  EXPECT_FALSE(contains(kepler({"-o", "-", "--quiet"}).out, "_lo"));
}

// hi + lo of the last row are hi + lo of the state, energy and invariants that --json tells.
TEST(WideNumbers, ARowOfTheTrajectoryReadsBackToTheSameNumbers) {
  const json result = json::parse(kepler({"--scalar", "quad", "--json"}).out);
  std::istringstream lines(kepler({"--scalar", "quad", "-o", "-", "--quiet"}).out);
  std::string head;
  std::string row;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("step,")) head = line;
    if (line.starts_with("20,")) row = line;
  }
  EXPECT_EQ(head, "step,t,q1,q2,p1,p2,H,L,A1,A2,q1_lo,q2_lo,p1_lo,p2_lo,H_lo,L_lo,A1_lo,A2_lo");
  std::vector<double> values;
  std::istringstream cells(row);
  for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
  ASSERT_EQ(values.size(), 18u);
  const json& state = result["state"];
  const std::vector<json> pairs = {state["q"], state["q_lo"], state["p"], state["p_lo"]};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(values[2 + i], pairs[0][i].get<double>());
    EXPECT_EQ(values[10 + i], pairs[1][i].get<double>());
    EXPECT_EQ(values[4 + i], pairs[2][i].get<double>());
    EXPECT_EQ(values[12 + i], pairs[3][i].get<double>());
  }
  EXPECT_EQ(values[7], result["invariants"]["L"]["final"].get<double>());
  EXPECT_EQ(values[15], result["invariants"]["L"]["final_lo"].get<double>());
  // L = q1 p2 - q2 p1 of the numbers in the row is the row's L = 4/5, though their doubles' is not.
  const auto wide = [&](std::size_t i) { return Quad(values[i]) + Quad(values[i + 8]); };
  EXPECT_LT(std::abs(wide(2) * wide(5) - wide(3) * wide(4) - wide(7)), 1e-19L);
}

TEST(WideNumbers, ArePrintedWithTheDigitsOfTheirScalar) {
  const runtime::Wide third = {.hi = 1.0 / 3.0, .lo = 1.850371707708594e-17};
  EXPECT_EQ(app::wide_text(third, 53), "0.3333333333333333");
  EXPECT_EQ(app::wide_text(third, 64), "0.33333333333333333333");
  EXPECT_EQ(app::wide_text(third, 113), "0.33333333333333333333333333333333");
  EXPECT_EQ(app::wide_text({.hi = 1e300}, 113).substr(0, 8), "1.000000");
  EXPECT_EQ(app::wide_text({.hi = HUGE_VAL}, 113), "");
}

// Their order is that of the numbers, their difference exact to the digits of a double.
TEST(WideNumbers, AreComparedAndSubtractedAsOneNumber) {
  const runtime::Wide x = {.hi = 1.0, .lo = 1e-17};
  const runtime::Wide y = {.hi = 1.0, .lo = -1e-17};
  EXPECT_LT(y, x);
  EXPECT_EQ(runtime::difference(x, y), 2e-17);
  EXPECT_EQ(runtime::difference({.hi = 1.0, .lo = 1e-17}, {.hi = 0x1p-60}), 1.0 - 0x1p-60 + 1e-17);
  EXPECT_EQ(runtime::difference({.hi = 1e16}, {.hi = -1.0, .lo = -1e-17}), 1e16);
}

}  // namespace
}  // namespace hamgen::app_test
