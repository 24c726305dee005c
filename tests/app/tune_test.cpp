#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/studies/tune_orbit.hpp"
#include "generator/pipeline.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

const std::string kPendulum = HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham";
const std::string kHenonHeiles = HAMGEN_SOURCE_DIR "/hamiltonians/henon_heiles.ham";
const std::string kHarmonic = HAMGEN_SOURCE_DIR "/hamiltonians/harmonic.ham";

json tuned(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "tune");
  arguments.insert(arguments.end(), {"--json", "--quiet"});
  const Result result = hamgen(arguments);
  EXPECT_EQ(result.status, 0) << result.err;
  return json::parse(result.out);
}

// The number of "-0.0025*h".
double coefficient(const json& gauge, const char* name) {
  const std::string text = gauge.at(name);
  EXPECT_TRUE(text.ends_with("*h")) << text;
  return std::strtod(text.c_str(), nullptr);
}

TEST(Tune, FindsThePairThatIsKnownInClosedFormForThePendulum) {
  const json result = tuned({kPendulum, "--time", "400", "--samples", "300"});
  ASSERT_EQ(result["gauges"].size(), 2u);
  const json& midpoint = result["gauges"][0];
  const json& pair = result["gauges"][1];
  // beta = -h E/12 and gamma = -h/12 make the h^2 term constant.  What is fitted is rounded to
  // 2^-53; its parts, eps^2 sin^2 q and p^2, differ from each other as much as from a constant.
  const double energy = -0.03 * std::cos(3.1);
  EXPECT_NEAR(coefficient(pair, "beta"), -energy / 12, 1e-12 * energy);
  EXPECT_NEAR(coefficient(pair, "gamma"), -1.0 / 12, 1e-12);
  EXPECT_EQ(result["rank"], 2);
  EXPECT_LT(pair["predicted_energy_spread"].get<double>(), 1e-20);
  // The next term: smaller by about (h w)^2/12 with w^2 = 0.03, 2.5e-5, or less.
  EXPECT_LT(pair["energy_spread"].get<double>(), 1e-4 * midpoint["energy_spread"].get<double>());
  EXPECT_NEAR(midpoint["energy_spread"].get<double>(),
              midpoint["predicted_energy_spread"].get<double>(), 1e-8);
  // What it costs is said.
  EXPECT_GT(pair["state_error"].get<double>(), midpoint["state_error"].get<double>());
  EXPECT_TRUE(midpoint["stable_below"].is_null());
  // Bounded while 1 + h beta > 0 and 1 - h gamma eps cos q > 0: h^2 < 12/max(E, -eps cos q), that
  // is 12/0.03 where q passes pi; E = 0.02997 is what the orbit reaches.
  EXPECT_NEAR(pair["stable_below"].get<double>(), std::sqrt(12 / energy), 1e-3);
  EXPECT_TRUE(result["worth_while"].get<bool>());
  // The command has the digits that matter: of the others the spread does not depend.
  const std::string command = result["command"];
  const std::size_t beta = command.find("'--beta=-0.0024978");
  ASSERT_NE(beta, std::string::npos) << command;
  EXPECT_LT(command.find("*h'", beta) - beta, std::string("'--beta=-0.0024978378").size());
}

TEST(Tune, PolishingReachesTheBestPairKnown) {
  const json result = tuned({kPendulum, "--h", "0.1", "--time", "2000", "--samples", "300",
                             "--polish", "--scalar", "long-double"});
  const json& best = result["gauges"].back();
  EXPECT_EQ(best["name"], "polished");
  // Found before in extended precision, to the digits that are given; the minimum of max H - min H
  // is sharp, so the simplex determines it to about its own size, 1e-7 of 1e-3 of the values.
  EXPECT_NEAR(coefficient(best, "beta"), -2.497814259e-3, 2e-12);
  EXPECT_NEAR(coefficient(best, "gamma"), -0.08333208388, 2e-10);
  EXPECT_NEAR(best["energy_spread"].get<double>(), 9.4e-13, 0.05e-13);
}

// Each form contains the one before, and the same compiled step measures them all.
TEST(Tune, AWiderFormPolishesNoWorseThanANarrowerOne) {
  double before = HUGE_VAL;
  for (const char* form : {"scalar", "diagonal", "matrix"}) {
    const json result = tuned(
        {kHenonHeiles, "--time", "100", "--samples", "200", "--polish", "--gauge-form", form});
    const double spread = result["gauges"].back()["energy_spread"];
    // A scalar's step is compiled to sums that round otherwise than those of a matrix: some units
    // of 2^-53 of H = 1/12, as in the test below.
    EXPECT_LE(spread, before + 1e-15) << form;
    before = spread;
    const bool ended = result["polish_ended"];
    const Result text = hamgen({"tune", kHenonHeiles, "--time", "100", "--samples", "200",
                                "--polish", "--gauge-form", form, "--quiet"});
    EXPECT_EQ(contains(text.out, "not yet at a minimum"), !ended) << text.out;
  }
}

TEST(Tune, SaysThatItIsWorthNothingWhereTheGainIsSmall) {
  for (const char* form : {"scalar", "matrix"}) {
    const Result result =
        hamgen({"tune", kHenonHeiles, "--time", "100", "--samples", "200", "--gauge-form", form});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "worth nothing here: the energy spread ")) << result.out;
  }
  const Result harmonic = hamgen({"tune", kHarmonic, "--time", "20", "--samples", "50"});
  EXPECT_TRUE(contains(harmonic.out, "nothing to tune: the midpoint rule keeps this energy"))
      << harmonic.out;
}

// Where the midpoint rule's run fails, no spread is gone.
TEST(Tune, HasNothingToCompareWithWhereTheMidpointRunFailed) {
  const std::string kepler = HAMGEN_SOURCE_DIR "/hamiltonians/kepler.ham";
  const std::vector<std::string> words = {"tune", kepler, "--steps",   "300",
                                          "--h",  "0.5",  "--samples", "50"};
  const Result result = hamgen(words);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "nothing to compare with: the run of the midpoint rule failed"))
      << result.out;
}

// A flat energy is not all: the phase of this one is better by more than a factor of two.
TEST(Tune, DoesNotCallABetterPhaseWorthNothing) {
  const Scratch scratch;
  const std::string model =
      scratch.write("bead.ham",
                    "coordinate q\nmomentum p\ntime t\n"
                    "H = p^2/(2*(1 + q^2)) + q^2/2 + q^4/4 - 0.3*q*cos(1.7*t)\n"
                    "scene driven { q = 0.5; h = 0.05; steps = 20000 }\n");
  const Result result = hamgen({"tune", model, "--time", "60"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "no flatter: the energy spread shrinks by a factor of 1."))
      << result.out;
  EXPECT_TRUE(contains(result.out, "the state error shrinks by a factor of")) << result.out;
}

TEST(Tune, TheGaugeItPrintsGivesTheSpreadItPrints) {
  const json result =
      tuned({kHenonHeiles, "--time", "50", "--samples", "200", "--gauge-form", "matrix"});
  const json& gauge = result["gauges"].back();
  const std::string beta = gauge["beta"];
  const std::string gamma = gauge["gamma"];
  const std::string steps = std::to_string(result["steps"].get<long>());
  const Result run = hamgen({"run", kHenonHeiles, "--beta=" + beta, "--gamma=" + gamma, "--steps",
                             steps, "--json", "--quiet"});
  ASSERT_EQ(run.status, 0) << run.err;
  const double spread = json::parse(run.out)["energy"]["spread"];
  // Coefficients as literals and as parameters are rounded alike; sums may not be: H is 1/12, its
  // spread some thousand units of 2^-53 of it away from rounding.
  EXPECT_NEAR(spread, gauge["energy_spread"].get<double>(), 1e-15);
}

TEST(Tune, DrawsTheMapOfTheEnergySpread) {
  const Scratch scratch;
  const std::string map = scratch.path("map.png");
  // Without gnuplot in the path, the table and the script are written all the same.
  std::filesystem::create_directory(scratch.path("bin"));
  for (const char* tool : {"g++", "as", "ld"})
    std::filesystem::create_symlink(std::string("/usr/bin/") + tool,
                                    scratch.path(std::string("bin/") + tool));
  const Result result =
      hamgen({"tune", kPendulum, "--time", "100", "--samples", "100", "--map", map, "--grid", "5"},
             {"PATH=" + scratch.path("bin"), "CXX=g++"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "no picture")) << result.err;
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"bin", "map.csv", "map.gp"}));
  std::vector<double> spreads;
  for (const std::string& line : lines(read(scratch.path("map.csv")))) {
    if (line.starts_with("#") || line.starts_with("b,")) continue;
    spreads.push_back(std::strtod(line.substr(line.rfind(',') + 1).c_str(), nullptr));
  }
  ASSERT_EQ(spreads.size(), 25u);
  // The grid goes from 0 to twice the pair: the pair itself is in the middle.
  EXPECT_EQ(std::ranges::min_element(spreads) - spreads.begin(), 12);
  const std::string script = read(scratch.path("map.gp"));
  for (const char* part : {"with image", "midpoint rule", "fitted: -0.0024978, -0.083333",
                           "best cell", "sure to stay bounded for b > -100, c < 333"})
    EXPECT_TRUE(contains(script, part)) << part;
  EXPECT_FALSE(contains(script, "set arrow")) << "the bound is far outside";
}

TEST(Tune, RefusesWhatMakesNoSense) {
  const auto refused = [](std::vector<std::string> arguments, std::string_view part) {
    arguments.insert(arguments.begin(), "tune");
    const Result result = hamgen(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_TRUE(contains(result.err, part)) << result.err;
    EXPECT_EQ(result.out, "");
  };
  refused({kPendulum, "--gauge-form", "round"}, "there are scalar, diagonal and matrix");
  refused({kPendulum, "--time", "0"}, "give another --time, --steps or --h");
  refused({kPendulum, "--time", "-10"}, "go in opposite directions");
  refused({kPendulum, "--samples", "2"}, "--samples 2");
  refused({kHenonHeiles, "--map", "m.png", "--gauge-form", "matrix"}, "--gauge-form scalar");
  // Before anything is computed: nothing is printed.
  refused({kPendulum, "--map", "m.png", "--grid", "0"}, "--grid 0");
  refused({kPendulum, "--map", "m.png", "--map-beta", "1:0"}, "LOW is below HIGH");
  refused({kPendulum, "--map", "m.pdf"}, "the name ends in .svg or .png");
  refused({kPendulum, "--grid", "5"}, "add --map FILE");
  refused({kPendulum, "--map-gamma", "0:1"}, "add --map FILE");
}

TEST(Tune, NamesItsOwnOptionForTheTime) {
  const Scratch scratch;
  const Result result = hamgen({"tune", scratch.write("m.ham", without_steps), "--h", "0.1"});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "--time 10")) << result.err;
  EXPECT_FALSE(contains(result.err, "--steps")) << result.err;
}

// A motion in a plane of space: what rests moves no energy, and has no say in the gauge.
TEST(Tune, WhatRestsIsLeftOutOfTheStepThatIsTuned) {
  const Scratch scratch;
  const std::string model =
      scratch.write("plane.ham",
                    "system plane\ncoordinate x, y, z\nmomentum px, py, pz\n"
                    "H = (px^2 + py^2 + pz^2)/2 + (x^2 + y^2)/2 + x^2*y + z^2*(1 + x)\n"
                    "scene s {\n  x = 1/10\n  py = 2/5\n  h = 1/10\n  steps = 200\n}\n");
  for (const char* form : {"scalar", "diagonal"}) {
    const std::vector<std::string> arguments = {model, "--samples", "100", "--gauge-form", form};
    std::vector<std::string> whole = arguments;
    whole.emplace_back("--whole");
    const json special = tuned(arguments);
    const json all = tuned(whole);
    EXPECT_EQ(special["gauges"].back()["beta"], all["gauges"].back()["beta"]) << form;
    const double spread = all["gauges"].back()["energy_spread"];
    EXPECT_NEAR(special["gauges"].back()["energy_spread"].get<double>(), spread, 1e-15) << form;
  }
}

// However many samples are still to come.
TEST(Tune, AnOrbitThatIsStoppedEnds) {
  const SourceText source =
      make_source("oscillator.ham",
                  "coordinate q\nmomentum p\nH = p^2/2 + q^4/4\nscene s { q = 1; h = 0.1 }\n");
  std::atomic<bool> stop = false;
  long samples = 0;
  const app::Orbit orbit =
      app::sample_orbit(source, scene_values(read_model(source), {}),
                        {.method = {},
                         .time = Rational(1),
                         .samples = 1'000'000'000,
                         .compiler = {},
                         .stop = &stop,
                         .on_progress = [&](double) { stop = ++samples == 3; }});
  EXPECT_EQ(orbit.points.size(), 3u);
  EXPECT_EQ(orbit.failure, "it was stopped");
}

}  // namespace
}  // namespace hamgen::app_test
