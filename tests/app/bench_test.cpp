// hamgen bench: its rows, its answer, its files.  What it chooses by time: bench_target_test.cpp.
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
  for (const json& row : result["rows"]) {
    EXPECT_DOUBLE_EQ(
        row["max_relative_energy_error"].get<double>() * result["energy_scale"].get<double>(),
        row["max_energy_error"].get<double>());
    EXPECT_DOUBLE_EQ(std::hypot(row["q_error"].get<double>(), row["p_error"].get<double>()),
                     row["state_error"].get<double>());
  }
  EXPECT_EQ(result["rows"][0]["steps"], 100);
  EXPECT_TRUE(result["rows"][0]["ns_per_step"].is_number());
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

TEST(Bench, TakesMembersOfTheFamilyAsMethods) {
  const Scratch scratch;
  const json result = bench_json({scratch.write("m.ham", pendulum), "--time", "10", "--h", "0.1",
                                  "--schemes", "alpha=0,symplectic-euler-a,alpha=1/2:gamma=-h/12"});
  const json& rows = result["rows"];
  EXPECT_EQ(rows[0]["state_error"], rows[1]["state_error"]);  // the same member by two names
  EXPECT_LT(rows[2]["state_error"], rows[0]["state_error"]);
}

// Neither given step is small enough, so there is one row more, the answer whatever it costs.
TEST(Bench, AnswersWhichStepReachesATarget) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  const json result = bench_json({model, "--time", "10", "--h", "0.2,0.1", "--target", "1e-7",
                                  "--schemes", "implicit-midpoint"});
  ASSERT_EQ(result["rows"].size(), 3u);
  ASSERT_EQ(result["time_for_error"].size(), 1u);
  const json& answer = result["time_for_error"][0];
  EXPECT_EQ(answer["error"], 1e-7);
  EXPECT_EQ(answer["row"], 2);
  EXPECT_EQ(answer["h"], result["rows"][2]["h"]);
  EXPECT_LE(result["rows"][2]["state_error"].get<double>(), 1e-7);
  EXPECT_EQ(answer["generate"],
            "hamgen generate " + model + " --scheme implicit-midpoint --scene swing");
  EXPECT_TRUE(answer["run"].get<std::string>().starts_with(
      "hamgen run " + model + " --scheme implicit-midpoint --scene swing --h "))
      << answer["run"];
  EXPECT_TRUE(
      contains(answer["run"].get<std::string>(), " --steps " + result["rows"][2]["steps"].dump()))
      << answer["run"];
}

TEST(Bench, SaysThatAStepAndTheTimeOfTheSceneHaveDifferentSigns) {
  const Result result = bench({HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham", "--h=-0.3",
                               "--steps", "20", "--schemes", "gauss-4"});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "goes the other way")) << result.err;
}

TEST(Bench, SaysSoWhenNoMethodReachesTheTarget) {
  const Scratch scratch;
  const Result result = bench({scratch.write("m.ham", pendulum), "--time", "10", "--h", "0.2,0.1",
                               "--target", "1e-30", "--schemes", "implicit-midpoint"});
  EXPECT_EQ(result.status, 1);
  EXPECT_TRUE(contains(result.out, "1e-30       -  no method reaches it")) << result.out;
}

// The first lines: what a reader came for.
TEST(Bench, AnswersBeforeItsRows) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  const Result result =
      bench({model, "--time", "10", "--h", "0.1", "--schemes", "implicit-midpoint,gauss-8"});
  EXPECT_EQ(result.status, 0) << result.err;  // 1e-10 was not asked for
  const std::vector<std::string> text = lines(result.out);
  ASSERT_GT(text.size(), 8u);
  EXPECT_EQ(text[1], "time for a state error, in seconds for a unit of the model's time:");
  EXPECT_TRUE(text[3].starts_with("  1e-4 ")) << text[3];
  EXPECT_TRUE(contains(text[4], "hamgen run " + model)) << text[4];
}

// From errors of 1e-2 to the floor of rounding, each of half the step before; and no further than
// h/64.
TEST(Bench, TakesTheStepsThatMatterForEachMethod) {
  const Scratch scratch;
  // Those of falling steps: behind them is one for the target, if it is thought to pay.
  const auto range_of = [&](const std::string& scheme) {
    json rows = bench_json({scratch.write("m.ham", pendulum), "--time", "60", "--schemes", scheme,
                            "--target", "1e-2"})["rows"];
    const auto step = [&](std::size_t i) { return rows[i]["h"].get<double>(); };
    std::size_t size = 1;
    while (size < rows.size() && step(size) < step(size - 1)) ++size;
    rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(size), rows.end());
    return rows;
  };
  const json gauss = range_of("gauss-8");
  const std::size_t count = gauss.size();
  ASSERT_GE(count, 4u);
  EXPECT_LE(gauss[0]["state_error"].get<double>(), 1e-2);
  EXPECT_GT(gauss[0]["h"].get<double>(), 0.2);
  for (std::size_t i = 0; i < count; ++i)
    EXPECT_EQ(gauss[i]["rounding_floor"].get<bool>(), i == count - 2) << gauss;
  EXPECT_LT(gauss[count - 2]["state_error"].get<double>(), 1e-11);

  const json euler = range_of("symplectic-euler-a");
  EXPECT_EQ(euler.back()["h"].get<double>(), 0.1 / 64);
  EXPECT_FALSE(euler.back()["rounding_floor"]);
}

TEST(Bench, SaysWhatIsNotSymplectic) {
  const Scratch scratch;
  const json result = bench_json(
      {scratch.write("m.ham", pendulum), "--time", "1", "--h", "0.1", "--schemes", "rk4"});
  EXPECT_FALSE(result["rows"][0]["symplectic"]);
  // Asked for by name it answers like the others.
  EXPECT_EQ(result["time_for_error"][0]["scheme"], "rk4");
}

TEST(Bench, NeedsNoReferenceForEnergiesAlone) {
  const Scratch scratch;
  const json result = bench_json({scratch.write("m.ham", pendulum), "--time", "1", "--h", "0.1",
                                  "--schemes", "rk4", "--observe", "energy"});
  EXPECT_TRUE(result["reference"]["failure"].is_null());
  EXPECT_TRUE(result["rows"][0]["state_error"].is_null());
  EXPECT_TRUE(result["rows"][0]["max_energy_error"].is_number());
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
