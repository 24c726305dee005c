// Runs that end before their steps are done: --until, --seconds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/run_results.hpp"

namespace hamgen::app_test {
namespace {

using nlohmann::json;

constexpr const char* kCircle =
    "system circle\ncoordinate q\nmomentum p\nparameter r = 1\nH = p^2/2 + q^2/2\n"
    "scene unit { q = r; h = 0.1; steps = 1000 }\n";

struct Ended {
  int status = -1;
  json report;
  Csv csv;
  std::string err;
};

Ended run_until(const std::vector<std::string>& options) {
  const Scratch scratch;
  std::vector<std::string> words = {"run",        scratch.write("circle.ham", kCircle),
                                    "--json",     "--quiet",
                                    "-o",         scratch.path("orbit.csv"),
                                    "--interpret"};
  if (std::ranges::find(options, "--scheme") == options.end())
    words.insert(words.end(), {"--scheme", "gauss-8"});
  words.insert(words.end(), options.begin(), options.end());
  const Result result = hamgen(words);
  Ended ended{.status = result.status, .report = {}, .csv = {}, .err = result.err};
  if (!result.out.empty()) ended.report = json::parse(result.out);
  if (!result.out.empty()) ended.csv = read_csv(read(scratch.path("orbit.csv")));
  return ended;
}

// q = cos(t).
TEST(Until, EndsAtACrossingWithItsState) {
  const Ended ended = run_until({"--until", "q"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.report["status"], "done");
  EXPECT_EQ(ended.report["ended"]["by"], "q");
  EXPECT_NEAR(ended.report["ended"]["t"], std::numbers::pi / 2, 1e-13);
  EXPECT_EQ(ended.report["ended"]["steps"], 15);
  EXPECT_EQ(ended.report["steps_done"], 16);  // the step in which it is
  EXPECT_LE(std::abs(ended.report["state"]["q"][0].get<double>()), 1e-15);
  // The last row is that of the crossing, before it are those of the steps.
  ASSERT_EQ(ended.csv.rows.size(), 17U);
  EXPECT_EQ(ended.csv.rows.back()[1], ended.report["ended"]["t"].get<double>());
  EXPECT_EQ(ended.csv.rows.back()[2], ended.report["state"]["q"][0].get<double>());
  EXPECT_EQ(ended.csv.rows[15][0], 15);
}

TEST(Until, KnowsDirectionsParametersAndTheFirstOfSeveral) {
  const Ended rising = run_until({"--until", "q rising"});
  EXPECT_NEAR(rising.report["ended"]["t"], 1.5 * std::numbers::pi, 1e-12);
  const Ended of_parameter = run_until({"--until", "q + r/2 falling"});
  EXPECT_NEAR(of_parameter.report["ended"]["t"], 2 * std::numbers::pi / 3, 1e-13);
  const Ended first = run_until({"--until", "q rising", "--until", "p + 1/2", "--until", "q"});
  EXPECT_EQ(first.report["ended"]["by"], "p + 1/2");
  EXPECT_NEAR(first.report["ended"]["t"], std::numbers::pi / 6, 1e-13);
}

// A direction that is asked for counts, whatever that of the event; else its own does.
TEST(Until, TakesTheDirectionThatIsAskedForOfAnEvent) {
  const Scratch scratch;
  const std::string model =
      scratch.write("circle.ham", std::string(kCircle) + "event both = q\nevent up = q rising\n");
  const auto time_of = [&](const char* condition) {
    const Result result = hamgen({"run", model, "--json", "--quiet", "--interpret", "--scheme",
                                  "gauss-8", "--until", condition});
    EXPECT_EQ(result.status, 0) << result.err;
    return json::parse(result.out)["ended"]["t"].get<double>();
  };
  constexpr double falling = 0.5 * std::numbers::pi;
  constexpr double rising = 1.5 * std::numbers::pi;
  EXPECT_NEAR(time_of("both"), falling, 1e-12);
  EXPECT_NEAR(time_of("both rising"), rising, 1e-12);
  EXPECT_NEAR(time_of("up"), rising, 1e-12);
  EXPECT_NEAR(time_of("up falling"), falling, 1e-12);
}

TEST(Until, EndsAfterTheFirstStepWhereAConditionHolds) {
  const Ended below = run_until({"--until", "q^2 < p^2"});  // from t = pi/4 on
  ASSERT_EQ(below.status, 0) << below.err;
  EXPECT_EQ(below.report["steps_done"], 8);
  EXPECT_EQ(below.csv.rows.size(), 9U);
  EXPECT_EQ(run_until({"--until", "r > 0"}).report["steps_done"], 0);  // from the beginning
  const Ended error = run_until({"--until", "energy_error > 1e-6", "--scheme", "rk4"});
  ASSERT_EQ(error.status, 0) << error.err;
  EXPECT_GT(error.report["energy"]["max_error"], 1e-6);
  const Ended before = run_until(
      {"--steps", std::to_string(error.report["steps_done"].get<int>() - 1), "--scheme", "rk4"});
  EXPECT_LT(before.report["energy"]["max_error"], 1e-6);
}

// What has been before the end is what would have been without one.
TEST(Until, ChangesNothingOfTheOrbit) {
  const Ended ended = run_until({"--until", "q rising"});
  const Ended whole = run_until({"--steps", "47"});
  ASSERT_GE(ended.csv.rows.size(), 47U);
  for (std::size_t i = 0; i < 47; ++i) EXPECT_EQ(ended.csv.rows[i], whole.csv.rows[i]) << i;
}

TEST(Until, SaysWhatNeverCameToPass) {
  const Ended never = run_until({"--until", "q - 2"});
  EXPECT_EQ(never.status, 1);
  EXPECT_EQ(never.report["status"], "done");
  EXPECT_FALSE(never.report.contains("ended"));
  EXPECT_TRUE(contains(never.err,
                       "--until q - 2 never crossed zero in 1000 steps: after each it "
                       "was between -2.9999"))
      << never.err;
  EXPECT_TRUE(contains(run_until({"--until", "q > 2"}).err, "never held in 1000 steps"));
  EXPECT_EQ(run_until({"--until", "q - 2", "--until", "q"}).status, 0);
}

// A collision on the way of the step that jumps across it.
TEST(Until, FindsACollisionInAStepThatFails) {
  const Scratch scratch;
  const std::string model =
      scratch.write("fall.ham",
                    "coordinate q\nmomentum p\nH = p^2/2 - 1/abs(q)\nevent hit = q - 1/20 falling\n"
                    "scene rest { q = 1; h = 0.01; steps = 1000 }\n");
  const std::vector<std::string> words = {
      "run", model, "--interpret", "--scheme", "stormer-verlet", "--json", "--quiet"};
  const auto with = [&words](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return hamgen(more);
  };
  const Result plain = with({});
  EXPECT_EQ(plain.status, 1);
  const json failed = json::parse(plain.out);
  EXPECT_EQ(failed["status"], "jumped");
  EXPECT_GT(failed["state"]["q"][0], 0.05);
  const Result result = with({"--until", "hit"});
  EXPECT_EQ(result.status, 0) << result.err;
  const json found = json::parse(result.out);
  EXPECT_EQ(found["status"], "done");
  ASSERT_TRUE(found.contains("ended"));
  EXPECT_LE(std::abs(found["state"]["q"][0].get<double>() - 0.05), 1e-16);
  // t = (acos(sqrt q) + sqrt(q - q^2))/sqrt 2; the step is large for what is found.
  const double exact = (std::acos(std::sqrt(0.05)) + std::sqrt(0.05 * 0.95)) / std::sqrt(2.0);
  EXPECT_NEAR(found["ended"]["t"], exact, 1e-3);
  EXPECT_EQ(with({"--until", "q + 1"}).status, 1);
}

TEST(Until, RefusesWhatIsNoCondition) {
  for (const auto& [text, words] : {std::pair<std::string, std::string>{"", "an empty word"},
                                    {"x", "unknown name 'x'"},
                                    {"q +", "expected"},
                                    {"q risign", "missing operator between 'q' and 'risign'"},
                                    {"q >= 1", "'>=' is not known here"},
                                    {"q > 1 rising", "a comparison has no direction"},
                                    {"q = 1", "does not belong in an expression"},
                                    {"2*energy_error > 1", "stands alone on one side"},
                                    {"energy_error", "stands alone on one side"},
                                    {"q > 1 > 0", "does not belong in an expression"},
                                    {"log(-1) > q", "log(-1)"}}) {
    const Ended refused = run_until({"--until", text});
    EXPECT_EQ(refused.status, 2) << text;
    EXPECT_TRUE(contains(refused.err, words)) << refused.err;
  }
  const Ended without = run_until({"--until", "energy_error > 1", "--observe", "q"});
  EXPECT_EQ(without.status, 2);
  EXPECT_TRUE(contains(without.err, "H is not computed in this run")) << without.err;
}

TEST(Seconds, EndARunThatSaysHowFarItCame) {
  const Ended ended = run_until({"--seconds", "1/20", "--steps", "1e12", "--every", "1e12"});
  EXPECT_EQ(ended.status, 6);
  EXPECT_EQ(ended.report["status"], "out of time");
  EXPECT_LT(ended.report["steps_done"], 1e12);
  EXPECT_GT(ended.report["steps_done"], 0);
  EXPECT_TRUE(contains(ended.err, "0.05 s were over after ")) << ended.err;
  EXPECT_FALSE(contains(ended.err, "smaller step")) << ended.err;
  for (const char* wrong : {"0", "-1", "x", "1/0"})
    EXPECT_NE(run_until({"--seconds", wrong}).status, 0) << wrong;
}

}  // namespace
}  // namespace hamgen::app_test
