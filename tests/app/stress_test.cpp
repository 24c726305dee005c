#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using Json = nlohmann::json;

const std::string models = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/";

Json cells_of(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "stress");
  arguments.insert(arguments.end(), {"--json", "--quiet"});
  const Result result = hamgen(arguments);
  EXPECT_EQ(result.status, 0) << result.err;
  return Json::parse(result.out).at("cells");
}

// The matrix of a member on a linear oscillator is known in closed form: its powers are bounded
// exactly where the bound says so.  Outside, the smallest growth over the grid, from the trace at
// the cells next to the bound, is beyond a factor of 1000 after 2000 steps.
TEST(Stress, TheRunsOfAnOscillatorAreBoundedWhereTheLinearBoundSaysSo) {
  for (const std::vector<std::string>& axes :
       {std::vector<std::string>{"--vary", "beta=-19:19:9", "--vary", "gamma=-19:19:9"},
        std::vector<std::string>{"--vary", "h=1.7:100:9", "--vary", "alpha=0.03:0.97:7"}}) {
    std::vector<std::string> arguments = {models + "harmonic.ham", "--steps", "2000",
                                          "--reference-seconds", "0"};
    arguments.insert(arguments.end(), axes.begin(), axes.end());
    int unbounded = 0;
    for (const Json& cell : cells_of(arguments)) {
      EXPECT_EQ(cell.at("bounded"), cell.at("linear_bounded")) << cell;
      unbounded += cell.at("bounded").get<bool>() ? 0 : 1;
    }
    EXPECT_GT(unbounded, 5);
  }
}

// After N steps of h the midpoint rule has turned (q, p) by 2 N atan(h/2) in place of N h: a chord
// of the unit circle.  Rounding over 300 steps stays below 1e-13.
TEST(Stress, TheStateErrorOfAnOscillatorIsThatOfItsAngle) {
  constexpr double steps = 300;
  for (const Json& cell : cells_of({models + "harmonic.ham", "--steps", "300", "--vary",
                                    "h=0.01:100:5", "--vary", "alpha=0.5:0.6:2"})) {
    if (cell.at("at").at("alpha") != 0.5) continue;
    const double h = cell.at("h");
    const double angle = steps * (2.0 * std::atan(h / 2.0) - h);
    EXPECT_NEAR(cell.at("state_error"), 2.0 * std::fabs(std::sin(angle / 2.0)), 1e-12) << cell;
    EXPECT_TRUE(cell.at("state_missing").is_null());
  }
}

TEST(Stress, AStateErrorThatIsNotKnownSaysWhy) {
  const Scratch scratch;
  const std::string path = scratch.write("collapse.ham", collapse);
  int ended = 0;
  for (const Json& cell : cells_of({path, "--vary", "h=1:100:5", "--steps", "1000"})) {
    EXPECT_NE(cell.at("state_error").is_null(), cell.at("state_missing").is_null()) << cell;
    if (!cell.at("state_missing").is_null()) ++ended;
  }
  EXPECT_EQ(ended, 5);  // the solution ends before any of the cells
  for (const Json& cell : cells_of({models + "pendulum.ham", "--vary", "h=1:2:2", "--steps", "10",
                                    "--reference-seconds", "0"}))
    EXPECT_EQ(cell.at("state_missing"), "references are not asked for");
}

TEST(Stress, EveryFailureIsAnOutcomeWithAName) {
  const Scratch scratch;
  const std::string path = scratch.write("collapse.ham", collapse);
  // q^2 = 1 - 2 t^2 reaches the singularity at t = 0.707.
  for (const Json& cell : cells_of({path, "--vary", "h=1:100:5", "--steps", "1000"})) {
    const std::string outcome = cell.at("outcome");
    EXPECT_TRUE(outcome == "jumped" || outcome == "not converged" || outcome == "left the domain" ||
                outcome == "overflow")
        << cell;
    EXPECT_TRUE(cell.at("energy_error").is_number()) << cell;
  }
}

TEST(Stress, AnEscapeIsNotAFailureOfTheStep) {
  const Scratch scratch;
  const std::string path =
      scratch.write("hill.ham",
                    "system hill\ncoordinate q\nmomentum p\nH = p^2/2 - q^2/2\n"
                    "scene s {\n  q = 1\n  h = 0.1\n  steps = 10\n}\n");
  const Json cells = cells_of({path, "--vary", "h=1:2:2", "--steps", "1000"});
  for (const Json& cell : cells) EXPECT_EQ(cell.at("outcome"), "escaped") << cell;
}

TEST(Stress, MistakesAreSaidWithAWayOut) {
  const std::string pendulum_model = models + "pendulum.ham";
  const auto refused = [&](const std::vector<std::string>& more, std::string_view part) {
    std::vector<std::string> arguments = {"stress", pendulum_model};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = hamgen(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_TRUE(contains(result.err, part)) << result.err;
  };
  refused({"--vary", "esp=1:2"}, "did you mean 'eps'?");
  refused({"--vary", "eps=1"}, "--vary eps=LOW:HIGH");
  refused({"--vary", "eps=2:1"}, "the range is empty");
  refused({"--vary", "h=0:1"}, "a step is more than 0");
  refused({"--vary", "beta=0:1", "--beta", "0.1"}, "both choose beta");
}

}  // namespace
}  // namespace hamgen::app_test
