// hamgen bench: its rows, its answer, its files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

// A bench of few rows and one round: times are not what these tests look at.
Result bench(std::vector<std::string> words) {
  const std::vector<std::string> quick = {"--rounds", "1", "--quiet"};
  words.insert(words.begin(), "bench");
  words.insert(words.end(), quick.begin(), quick.end());
  return hamgen(words);
}

json bench_json(std::vector<std::string> words) {
  words.emplace_back("--json");
  const Result result = bench(words);
  EXPECT_EQ(result.status, 0) << result.err;
  return json::parse(result.out);
}

TEST(Bench, ErrorsFallWithTheOrderOfTheMethod) {
  const Scratch scratch;
  const json result = bench_json({scratch.write("m.ham", pendulum), "--time", "10", "--h",
                                  "0.1,0.05", "--schemes", "implicit-midpoint,symplectic-euler-a"});
  ASSERT_EQ(result["rows"].size(), 4u);
  const auto ratio = [&](std::size_t row, const char* error) {
    return result["rows"][row][error].get<double>() / result["rows"][row + 1][error].get<double>();
  };
  // Orders 2 and 1: halving h divides the errors by 4 and 2, up to terms of higher order in h,
  // which at h = 0.1 and a frequency of 0.17 are below a twentieth.
  for (const char* error : {"state_error", "max_energy_error"}) {
    EXPECT_NEAR(ratio(0, error), 4.0, 0.2) << error;
    EXPECT_NEAR(ratio(2, error), 2.0, 0.2) << error;
  }
  EXPECT_EQ(result["rows"][0]["steps"], 100);
  EXPECT_GT(result["rows"][0]["ns_per_step"].get<double>(), 0.0);
}

// rk4 has four stages, Gauss of order 4 two in each iteration; Stormer-Verlet keeps the gradient of
// its last kick.
TEST(Bench, CountsTheGradientsOfAStep) {
  const Scratch scratch;
  const json result = bench_json({scratch.write("m.ham", pendulum), "--time", "10", "--h", "0.1",
                                  "--schemes", "rk4,gauss-4,stormer-verlet,implicit-midpoint"});
  const json& rows = result["rows"];
  EXPECT_EQ(rows[0]["gradients_per_step"], 4.0);
  EXPECT_EQ(rows[1]["gradients_per_step"].get<double>(),
            2.0 * rows[1]["iterations_per_step"].get<double>());
  EXPECT_EQ(rows[2]["gradients_per_step"], 1.0);
  EXPECT_EQ(rows[3]["gradients_per_step"], rows[3]["iterations_per_step"]);
  EXPECT_GT(rows[3]["gradients_per_step"], 1.0);
}

// Where the largest step is better than asked for, a larger one is tried.
TEST(Bench, TriesLargerStepsForATarget) {
  const Scratch scratch;
  const json result = bench_json({scratch.write("m.ham", pendulum), "--time", "10", "--h",
                                  "0.1,0.05", "--target", "1e-4", "--schemes", "gauss-4"});
  const json& row = result["rows"][result["answer"]["row"].get<std::size_t>()];
  EXPECT_GT(row["h"], 0.2);
  EXPECT_LE(row["state_error"], 1e-4);
}

TEST(Bench, TakesMembersOfTheFamilyAsMethods) {
  const Scratch scratch;
  const json result = bench_json({scratch.write("m.ham", pendulum), "--time", "10", "--h", "0.1",
                                  "--schemes", "alpha=0,symplectic-euler-a,alpha=1/2:gamma=-h/12"});
  const json& rows = result["rows"];
  EXPECT_EQ(rows[0]["state_error"], rows[1]["state_error"]);  // the same member by two names
  EXPECT_LT(rows[2]["state_error"], rows[0]["state_error"]);
}

TEST(Bench, AnswersWhichStepReachesATarget) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  const json result = bench_json({model, "--time", "10", "--h", "0.2,0.1", "--target", "1e-7",
                                  "--schemes", "implicit-midpoint,symplectic-euler-a"});
  // Neither step is small enough: smaller ones were tried by the errors' power of h.
  const json& answer = result["answer"];
  ASSERT_TRUE(answer["row"].is_number());
  const json& row = result["rows"][answer["row"].get<std::size_t>()];
  EXPECT_GT(answer["row"].get<std::size_t>(), 3u);
  EXPECT_EQ(row["scheme"], "implicit-midpoint");
  EXPECT_LE(row["state_error"].get<double>(), 1e-7);
  EXPECT_GE(row["state_error"].get<double>(), 0.5e-7);
  EXPECT_EQ(answer["command"], "hamgen generate " + model + " --scheme implicit-midpoint");
}

// The step of the answer for one method.
double answered_step(const std::vector<std::string>& words) {
  const json result = bench_json(words);
  return result["rows"][result["answer"]["row"].get<std::size_t>()]["h"];
}

const std::string kModels = HAMGEN_SOURCE_DIR "/hamiltonians/";

// The search ends within 3 % of the border, so that a step 4 % larger misses, where the error is a
// power of h.  Of the double pendulum it changes its sign near the border: no more is said there
// than that a step above the given one is found.
TEST(Bench, TheStepForATargetIsNearlyTheLargestOne) {
  struct Case {
    std::string model, scheme, target, steps;
    double given;  // the largest given step that meets the target
    bool is_power = true;
  };
  const std::vector<Case> cases = {
      {"pendulum.ham", "kahan-li-8-verlet", "1e-10", "0.8,0.4,0.2,0.1", 0.8},
      {"pendulum.ham", "kahan-li-8-verlet", "1e-9", "0.2,0.1,0.05", 0.2},
      {"morse.ham", "blanes-moan-rkn-6", "1e-6", "0.4,0.2,0.1,0.05", 0.2},
      {"double_pendulum.ham", "gauss-8", "1e-9", "0.16,0.08,0.04", 0.08, false}};
  for (const auto& [model, scheme, target, steps, given, is_power] : cases) {
    const std::string path = kModels + model;
    const double h = answered_step({path, "--schemes", scheme, "--target", target, "--h", steps});
    EXPECT_GT(h, 1.1 * given) << model << ' ' << target;
    if (!is_power) continue;
    const json larger = bench_json({path, "--schemes", scheme, "--h", std::to_string(1.04 * h)});
    EXPECT_GT(larger["rows"][0]["state_error"].get<double>(), std::stod(target)) << model << h;
  }
}

TEST(Bench, AWeakerTargetIsReachedWithALargerStep) {
  double before = 0.0;
  for (const char* target : {"1e-8", "1e-7", "1e-6", "1e-5", "1e-4"}) {
    const double h = answered_step({kModels + "morse.ham", "--schemes", "blanes-moan-rkn-6", "--h",
                                    "0.4,0.2,0.1", "--target", target});
    EXPECT_GT(h, before) << target;
    before = h;
  }
}

// Steps that missed on the way are no rows and so not drawn either; a method has at most one more.
TEST(Bench, ShowsOnlyTheStepThatMeetsTheTarget) {
  const json rows =
      bench_json({kModels + "pendulum.ham", "--schemes", "kahan-li-8-verlet,blanes-moan-6,gauss-8",
                  "--target", "1e-9", "--h", "0.4,0.2"})["rows"];
  constexpr std::size_t given = 6;
  EXPECT_GT(rows.size(), given);
  EXPECT_LE(rows.size(), given + 3);
  for (std::size_t i = given; i < rows.size(); ++i)
    EXPECT_LE(rows[i]["state_error"].get<double>(), 1e-9) << rows[i];
}

TEST(Bench, SaysSoWhenNoMethodReachesTheTarget) {
  const Scratch scratch;
  const Result result = bench({scratch.write("m.ham", pendulum), "--time", "10", "--h", "0.2,0.1",
                               "--target", "1e-30", "--schemes", "implicit-midpoint"});
  EXPECT_EQ(result.status, 1);
  EXPECT_TRUE(contains(result.out, "no method reaches the state error 1e-30")) << result.out;
}

TEST(Bench, AFailureIsARowAndNotTheEnd) {
  const Scratch scratch;
  // Falls into the singularity at t = 0.707: there is no reference, and no step gets past it.
  const Result result = bench({scratch.write("m.ham", collapse), "--time", "1", "--h", "0.01",
                               "--schemes", "implicit-midpoint", "--json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(contains(result.err, "no reference solution")) << result.err;
  const json rows = json::parse(result.out)["rows"];
  EXPECT_NE(rows[0]["outcome"], "done");
  EXPECT_TRUE(rows[0]["state_error"].is_null());
  EXPECT_TRUE(rows[0]["s_per_time"].is_null());
}

TEST(Bench, EveryRowEndsAtTheSameTime) {
  const Scratch scratch;
  const json result = bench_json({scratch.write("m.ham", pendulum), "--time", "1", "--h", "0.3",
                                  "--schemes", "implicit-midpoint"});
  EXPECT_EQ(result["rows"][0]["steps"], 4);
  EXPECT_EQ(result["rows"][0]["h"], 0.25);
}

TEST(Bench, KeepsReferencesAndFindsThemAgain) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", two_oscillators);
  const std::vector<std::string> words = {
      "bench", model,      "--initial", "x=1,py=1", "--time",  "3",         "--h",
      "0.1",   "--rounds", "1",         "--json",   "--quiet", "--schemes", "implicit-midpoint"};
  const std::vector<std::string> own = {"HAMGEN_CACHE=" + scratch.path("cache")};
  const json first = json::parse(hamgen(words, own).out)["reference"];
  const json second = json::parse(hamgen(words, own).out)["reference"];
  EXPECT_FALSE(first["from_cache"]);
  EXPECT_TRUE(second["from_cache"]);
  EXPECT_EQ(first["state"], second["state"]);
  // x = cos t, y = (1/2) sin 2t, each to the rounding of a double.
  EXPECT_DOUBLE_EQ(second["state"][0][0], std::cos(3.0));
  EXPECT_DOUBLE_EQ(second["state"][1][0], std::sin(6.0) / 2);
  EXPECT_TRUE(contains(hamgen({"cache", "list"}, own).out, "1 reference solution"));
  // Another time is another reference.
  std::vector<std::string> other = words;
  other[5] = "4";
  EXPECT_FALSE(json::parse(hamgen(other, own).out)["reference"]["from_cache"]);
  EXPECT_EQ(hamgen({"cache", "clear"}, own).status, 0);
  for (const auto& entry : std::filesystem::directory_iterator(scratch.path("cache")))
    ADD_FAILURE() << entry.path() << " is left in the cache";
}

TEST(Bench, WritesTableScriptAndPicture) {
  const Scratch scratch;
  const std::string directory = scratch.path("out");
  const Result result = bench({scratch.write("m.ham", pendulum), "--time", "10", "--h", "0.2,0.1",
                               "--schemes", "implicit-midpoint", "-o", directory});
  EXPECT_EQ(result.status, 0) << result.err;
  const std::vector<std::string> table = lines(read(directory + "/bench.csv"));
  ASSERT_EQ(std::ranges::count_if(table, [](const auto& line) { return !line.starts_with("#"); }),
            3);
  EXPECT_EQ(json::parse(read(directory + "/bench.json"))["rows"].size(), 2u);
  const std::string picture = read(directory + "/bench.svg");
  EXPECT_TRUE(contains(picture, "<svg"));
  EXPECT_TRUE(contains(picture, "implicit-midpoint"));
}

TEST(Bench, SaysWhereItWasMeasured) {
  const Scratch scratch;
  const std::string directory = scratch.path("out");
  const std::string picture = scratch.path("own.png");
  const Result result =
      bench({scratch.write("m.ham", pendulum), "--time", "1", "--h", "0.1", "--schemes",
             "implicit-midpoint", "-o", directory, "--plot", picture});
  ASSERT_EQ(result.status, 0) << result.err;
  const json whole = json::parse(read(directory + "/bench.json"));
  const std::string table = read(directory + "/bench.csv");
  for (const char* key : {"machine", "compiler", "flags", "date"})
    EXPECT_TRUE(contains(table, whole[key].get<std::string>())) << key;
  EXPECT_TRUE(contains(whole["flags"].get<std::string>(), "-O3"));
  EXPECT_TRUE(contains(whole["machine"].get<std::string>(), " threads"));
  EXPECT_EQ(whole["date"].get<std::string>().size(), std::string("2026-01-31").size());
  // A picture of its own is drawn beside that of the directory.
  EXPECT_TRUE(std::filesystem::exists(directory + "/bench.svg"));
  EXPECT_TRUE(std::filesystem::exists(picture));
}

TEST(Bench, TakesAGaugeOfTheMidpointRuleByEitherName) {
  const Scratch scratch;
  const json result =
      bench_json({scratch.write("m.ham", pendulum), "--time", "10", "--h", "0.1", "--schemes",
                  "implicit-midpoint:gauge=locally-exact,gauge=locally-exact,implicit-midpoint"});
  const json& rows = result["rows"];
  EXPECT_EQ(rows[0]["outcome"], "done");
  EXPECT_EQ(rows[0]["state_error"], rows[1]["state_error"]);
  EXPECT_NE(rows[0]["state_error"], rows[2]["state_error"]);
}

TEST(Bench, NamesItsOwnOptionForTheTime) {
  const Scratch scratch;
  for (const std::string& model :
       {scratch.write("a.ham", without_steps), scratch.write("b.ham", two_oscillators)}) {
    const Result result = hamgen({"bench", model, "--h", "0.1"});
    EXPECT_EQ(result.status, 2);
    EXPECT_TRUE(contains(result.err, "--time 10")) << result.err;
    EXPECT_FALSE(contains(result.err, "--steps")) << result.err;
  }
}

TEST(Bench, WithoutGnuplotTheScriptStays) {
  const Scratch scratch;
  // Nothing but what the compiler calls in the path, so no gnuplot.
  for (const char* tool : {"as", "ld"})
    std::filesystem::create_symlink(std::string("/usr/bin/") + tool, scratch.path(tool));
  const Result result = hamgen({"bench", scratch.write("m.ham", pendulum), "--time", "10", "--h",
                                "0.2,0.1", "--schemes", "implicit-midpoint", "--rounds", "1",
                                "--compiler", "/usr/bin/g++", "-o", scratch.path("out")},
                               {"PATH=" + scratch.path("")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "no picture: gnuplot could not be started")) << result.err;
  EXPECT_TRUE(std::filesystem::exists(scratch.path("out/bench.gp")));
  EXPECT_TRUE(std::filesystem::exists(scratch.path("out/bench.csv")));
  EXPECT_FALSE(std::filesystem::exists(scratch.path("out/bench.svg")));
}

TEST(Bench, RefusesWhatMakesNoSense) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--schemes", "implicit-midpiont"}, "did you mean 'implicit-midpoint'?"},
      {{"--schemes", "alpha=1/2:delta=1"}, "'delta=1' is none of"},
      {{"--schemes", "alpha=1/2,beta=alpha*h"}, "--schemes beta=alpha*h: alpha has no value"},
      {{"--observe", "phase"}, "energy and state"},
      {{"--target", "0"}, "not a positive number"},
      {{"--h", "0"}, "h"},
      {{"--time", "1e12"}, "change --h or --time"},
      {{"--time", "-5"}, "opposite directions"},
      {{"--plot", "picture.pdf"}, ".svg or .png"},
      {{"--rounds", "0"}, "not an integer"}};
  for (const auto& [words, part] : cases) {
    std::vector<std::string> all = {"bench", model, "--quiet"};
    all.insert(all.end(), words.begin(), words.end());
    const Result result = hamgen(all);
    EXPECT_EQ(result.status, 2) << words[0] << ' ' << words[1] << ": " << result.err;
    EXPECT_TRUE(contains(result.err, part)) << result.err;
    EXPECT_EQ(result.out, "");
  }
}

}  // namespace
}  // namespace hamgen::app_test
