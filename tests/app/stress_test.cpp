#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using Json = nlohmann::json;

const std::string models = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/";

// Every cell and every reference has all the time it needs.
Result stress(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "stress");
  arguments.insert(arguments.end(), {"--quiet", "--seconds", "3600"});
  if (std::ranges::find(arguments, "--reference-seconds") == arguments.end())
    arguments.insert(arguments.end(), {"--reference-seconds", "3600"});
  return hamgen(arguments);
}

Json cells_of(std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  const Result result = stress(arguments);
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

// A polynomial has no domain to leave: inf - inf of its terms is an overflow, long before a state
// whose cube is 1e308 is itself beyond 1e50.  The reciprocal in `collapse` has one.
TEST(Stress, WhatIsNotFiniteInAPolynomialIsAnOverflow) {
  int overflows = 0;
  for (const Json& cell :
       cells_of({models + "stiff_fpu.ham", "--vary", "h=177.8279410038923:1000:2", "--vary",
                 "w=170.1901334924234:300:2", "--steps", "300", "--scheme", "symplectic-euler-b",
                 "--reference-seconds", "0"})) {
    EXPECT_NE(cell.at("outcome"), "left the domain") << cell;
    overflows += cell.at("outcome") == "overflow" ? 1 : 0;
  }
  EXPECT_EQ(overflows, 4);
}

TEST(Stress, WhereTheRootOfANegativeNumberIsMetTheDomainWasLeft) {
  const Scratch scratch;
  const std::string path =
      scratch.write("edge.ham",
                    "system edge\ncoordinate q\nmomentum p\nH = p^2/2 + q - sqrt(1 - q)\n"
                    "scene s {\n  q = 0\n  p = 20\n  h = 0.1\n  steps = 10\n}\n");
  for (const Json& cell :
       cells_of({path, "--vary", "h=1:2:2", "--steps", "1000", "--scheme", "symplectic-euler-a"}))
    EXPECT_EQ(cell.at("outcome"), "left the domain") << cell;
}

// The Kepler scene begins at p2 = sqrt((1 + e)/(1 - e)): no ellipse from e = 1 on.
TEST(Stress, ValuesThatTheSceneDoesNotAllowAreAnOutcomeOfTheirCells) {
  const Json cells = cells_of(
      {models + "kepler.ham", "--vary", "e=0:2:5", "--vary", "h=0.1:10:3", "--steps", "10"});
  ASSERT_EQ(cells.size(), 15u);
  for (const Json& cell : cells) {
    const double e = cell.at("at").at("e");
    EXPECT_EQ(cell.at("outcome") == "undefined", e >= 1.0) << cell;
    EXPECT_EQ(cell.at("reason").is_null(), e < 1.0) << cell;
    EXPECT_EQ(cell.at("energy_error").is_null(), e >= 1.0) << cell;
    EXPECT_EQ(cell.at("reason") == "division by zero", e == 1.0) << cell;
    EXPECT_EQ(cell.at("state_error").is_null(), e >= 1.0) << cell;
  }
  // Nothing but that is an error of the command.
  const Result none = stress({models + "kepler.ham", "--vary", "e=1:2:5"});
  EXPECT_EQ(none.status, 3) << none.err;
  EXPECT_TRUE(contains(none.err, "kepler.ham:19")) << none.err;
}

TEST(Stress, APoleOfTheGaugeIsAnOutcomeOfItsCells) {
  // w = 1, h = 0.1 in the scene: h w = 2 pi, and between two poles.
  const Json cells = cells_of({models + "harmonic.ham", "--gauge", "locally-exact", "--vary",
                               "h=62.83185307179586:94.24777960769379:2", "--steps", "10"});
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0].at("outcome"), "undefined");
  EXPECT_TRUE(contains(cells[0].at("reason"), "the gauge has a pole at h = 6.283")) << cells[0];
  EXPECT_EQ(cells[1].at("outcome"), "done") << cells[1];
}

// At rest in the equilibrium every step is exact, and that is no error of 10^0.
TEST(Stress, AnErrorOfExactlyZeroIsDrawnAsTheBest) {
  const Result result = stress({models + "pendulum.ham", "--scene", "libration_08", "--initial",
                                "q=0,p=0", "--vary", "h=1:2:3", "--steps", "10"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, " ***\n")) << result.out;
  EXPECT_FALSE(contains(result.out, " 000\n")) << result.out;
}

// In print a cell of which nothing is known may not look like a perfect one: hatched, all others
// plain.  q' = q^2 from 1 is infinite at t = 1; three explicit steps of 0.5 do not notice.
TEST(Stress, AnUnknownCellIsDrawnUnlikeAnyOther) {
  const Scratch scratch;
  const std::string path =
      scratch.write("ends.ham",
                    "system ends\ncoordinate q\nmomentum p\nH = p*q^2\n"
                    "scene s {\n  q = 1\n  p = 1\n  h = 0.5\n  steps = 10\n}\n");
  const Result result = stress({path, "--vary", "h=0.1:1:2", "--steps", "3", "--scheme",
                                "symplectic-euler-a", "--plot", scratch.path("m.svg")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "known in 1 of 2 cells")) << result.out;
  std::istringstream script(read(scratch.path("m.gp")));
  int hatched = 0;
  for (std::string line; std::getline(script, line);) {
    if (!contains(line, "keyentry with boxes")) continue;
    EXPECT_EQ(contains(line, "fs pattern"), contains(line, "'not known'")) << line;
    hatched += contains(line, "fs pattern") ? 1 : 0;
  }
  EXPECT_EQ(hatched, 1);
}

// Symplectic Euler is bounded on H = (p^2 + w^2 q^2)/2 where h w < 2; what stands in the script is
// found by halving an 80th of an axis, 2 long, twelve times, and has nine digits.
TEST(Stress, APictureHasTheBorderOfTheLinearBound) {
  const Scratch scratch;
  const std::string path =
      scratch.write("oscillator.ham",
                    "system oscillator\ncoordinate q\nmomentum p\nparameter w = 1\n"
                    "H = (p^2 + w^2*q^2)/2\n"
                    "scene s {\n  q = 1\n  h = 1\n  steps = 10\n}\n");
  const Result result =
      stress({path, "--vary", "h=0.5:2.5:2", "--vary", "w=0.5:2.5:2", "--scheme",
              "symplectic-euler-a", "--reference-seconds", "0", "--plot", scratch.path("m.svg")});
  EXPECT_EQ(result.status, 0) << result.err;
  std::istringstream script(read(scratch.path("m.gp")));
  std::string line;
  while (std::getline(script, line) && line != "$bound << EOD") continue;
  int points = 0;
  while (std::getline(script, line) && line != "EOD") {
    std::istringstream numbers(line);
    double h = 0;
    double w = 0;
    numbers >> h >> w;
    EXPECT_NEAR(h * w, 2, 2.5 * 2 / 80 / 4096 + 1e-8) << line;
    ++points;
  }
  // A line across in each direction for every 160th of an axis from 2/2.5 on.
  EXPECT_GT(points, 200);
}

// Half a picture, as on a full disk, of which gnuplot says nothing.
TEST(Stress, APictureAppearsWholeOrNotAtAll) {
  const Scratch scratch;
  const std::string fake =
      scratch.write("gnuplot",
                    "#!/bin/sh\nout=$(sed -n \"s/^set output '\\(.*\\)'$/\\1/p\" \"$1\")\n"
                    "printf '<svg>%s' \"$END\" > \"$out\"\n");
  std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
  const std::string path = std::string("PATH=") + scratch.path("") + ":" + std::getenv("PATH");
  const std::string picture = scratch.path("m.svg");
  const std::vector<std::string> command = {
      "stress", models + "harmonic.ham", "--vary", "h=1:2:2", "--steps",
      "5",      "--reference-seconds",   "0",      "--quiet", "--plot",
      picture};
  const Result half = hamgen(command, {path, "END="});
  EXPECT_EQ(half.status, 4) << half.err;
  EXPECT_TRUE(contains(half.err, "m.svg': gnuplot did not write all of it: is the disk full?"))
      << half.err;
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"gnuplot", "m.gp"}));
  const Result whole = hamgen(command, {path, "END=</svg>"});
  EXPECT_EQ(whole.err, "");
  EXPECT_TRUE(read(picture).starts_with("<svg>") && read(picture).ends_with("</svg>"));
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"gnuplot", "m.gp", "m.svg"}));
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
    std::vector<std::string> arguments = {pendulum_model};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = stress(arguments);
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
