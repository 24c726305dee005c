// hamgen run --checkpoint and --resume: bit for bit the run that nobody interrupted.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

using Json = nlohmann::json;

std::vector<std::string> and_more(std::vector<std::string> words,
                                  const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// What a run says of itself, but for its times.
std::string without_times(const std::string& text) {
  Json json = Json::parse(text);
  json.erase("time");
  json.erase("trajectory");
  json.erase("header");
  return json.dump(1);
}

class CheckpointedRun {
 public:
  CheckpointedRun(std::string_view model, const std::vector<std::string>& method,
                  const std::string& steps)
      : words_(and_more({"run", scratch_.write("model.ham", model), "--quiet", "--json", "--steps",
                         steps, "--every", "1000"},
                        method)) {
    const Result whole = hamgen(and_more(words_, {"-o", scratch_.path("whole.csv")}));
    EXPECT_EQ(whole.status, 0) << whole.err;
    rows_ = read(scratch_.path("whole.csv"));
    json_ = without_times(whole.out);
  }

  // With what a command is begun and gone on with.
  [[nodiscard]] std::vector<std::string> command() const {
    const bool begins = !std::filesystem::exists(scratch_.path("c"));
    return and_more(words_, {"-o", scratch_.path("x.csv"), "--every-seconds", "0",
                             begins ? "--checkpoint" : "--resume", scratch_.path("c")});
  }
  // One command, killed the `place`th time it comes to a place where that can be; whether it was.
  bool is_killed_at(int place) {
    const Result result = hamgen(command(), {"HAMGEN_KILL_POINT=" + std::to_string(place)});
    if (result.status == 128 + SIGKILL) return true;
    EXPECT_EQ(result.status, 0) << result.err;
    expect_the_same(result.out);
    return false;
  }
  void expect_the_same(const std::string& json) {
    EXPECT_EQ(without_times(json), json_);
    EXPECT_TRUE(read(scratch_.path("x.csv")) == rows_);
    EXPECT_EQ(scratch_.names(), (std::vector<std::string>{"model.ham", "whole.csv", "x.csv"}));
  }
  [[nodiscard]] const Scratch& scratch() const { return scratch_; }
  [[nodiscard]] const std::vector<std::string>& words() const { return words_; }

 private:
  Scratch scratch_;
  std::vector<std::string> words_;
  std::string rows_, json_;
};

// Before and after the rename of each checkpoint, and of the rows.
TEST(Checkpoint, OfARunThatIsKilledManyTimesGoesOnBitForBit) {
  CheckpointedRun run(pendulum, {}, "200000");
  int kills = 0;
  while (run.is_killed_at(kills % 13 + 2) && kills < 300) ++kills;
  EXPECT_GE(kills, 10);
  EXPECT_LT(kills, 300);
}

void keeps_what_steps_remember(std::string_view model, const std::vector<std::string>& method) {
  CheckpointedRun run(model, method, "3000");
  ASSERT_TRUE(run.is_killed_at(7));
  int kills = 1;
  while (run.is_killed_at(9) && kills < 50) ++kills;
  EXPECT_GE(kills, 3);
  EXPECT_LT(kills, 50);
}

TEST(Checkpoint, KeepsWhatStepsRemember) {
  keeps_what_steps_remember(chain, {"--scheme", "yoshida-4", "--scalar", "float"});
}
TEST(CheckpointLong, KeepsWhatStepsRemember) {
  keeps_what_steps_remember(pendulum, {"--scheme", "gauss-8"});
  keeps_what_steps_remember(pendulum, {"--order", "4", "--scalar", "quad"});
  keeps_what_steps_remember(chain, {"--set", "N=40"});
}

TEST(Checkpoint, OfARunOutOfTimeSaysWhereItsRowsAreAndHowToGoOn) {
  const Scratch scratch;
  const Result result =
      hamgen({"run", scratch.write("pendulum.ham", pendulum), "--steps", "1e12", "--every", "1e6",
              "--seconds", "0.01", "-o", scratch.path("x.csv"), "--checkpoint", scratch.path("c")});
  EXPECT_EQ(result.status, 6) << result.err;
  EXPECT_TRUE(contains(result.out + result.err, "x.csv.part, ")) << result.out << result.err;
  EXPECT_TRUE(contains(result.err, "--resume " + scratch.path("c") + " goes on")) << result.err;
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"c", "pendulum.ham", "x.csv.part"}));
}

// The negative control: from the state alone, even with all its digits, it is another run.
TEST(Checkpoint, IsMoreThanTheState) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const auto run = [&](const std::string& steps, const std::string& q, const std::string& p) {
    const Result result = hamgen(
        {"run", model, "--quiet", "--json", "--steps", steps, "--initial", "q=" + q + ",p=" + p});
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(result.out)["state"];
  };
  const auto half = run("5000", "3.1", "0");
  const auto parts = run("5000", half["q"][0].dump(), half["p"][0].dump());
  EXPECT_NE(parts, run("10000", "3.1", "0"));
}

void kill_runs_often(int kills) {
  CheckpointedRun run(pendulum, {}, "2000000");
  std::mt19937 random(1);
  int met = 0;
  while (met < kills) {
    const int status =
        status_if_killed(run.command(), std::chrono::microseconds(random() % 120000));
    ASSERT_TRUE(status == 128 + SIGKILL || status == 0);
    met += status == 128 + SIGKILL ? 1 : 0;
    const bool is_done = std::filesystem::exists(run.scratch().path("x.csv")) &&
                         !std::filesystem::exists(run.scratch().path("c"));
    if (!is_done) continue;
    ASSERT_EQ(read(run.scratch().path("x.csv")), read(run.scratch().path("whole.csv")));
    std::filesystem::remove(run.scratch().path("x.csv"));
  }
  const Result last = hamgen(run.command());
  EXPECT_EQ(last.status, 0) << last.err;
  // A kill may leave the temporary file of a checkpoint to the next one.
  EXPECT_TRUE(read(run.scratch().path("x.csv")) == read(run.scratch().path("whole.csv")));
}

TEST(Checkpoint, GoesOnAfterTenKillsAtRandomMoments) { kill_runs_often(10); }
TEST(CheckpointLong, GoesOnAfterTwoHundredKillsAtRandomMoments) { kill_runs_often(200); }

TEST(Checkpoint, OfAnotherRunOrNoneIsRefused) {
  CheckpointedRun run(pendulum, {}, "100000");
  ASSERT_TRUE(run.is_killed_at(9));
  const Scratch& scratch = run.scratch();
  const std::string good = read(scratch.path("c"));
  // Rows can be read while the run goes on.
  EXPECT_TRUE(read(scratch.path("whole.csv")).starts_with(read(scratch.path("x.csv.part"))));
  EXPECT_TRUE(contains(read(scratch.path("x.csv.part")), "\nstep,t,q,p,H\n0,0,3.1,0,"));
  const auto refused = [&](const std::vector<std::string>& more, int status,
                           std::string_view part) {
    const Result result = hamgen(and_more(run.command(), more));
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_TRUE(contains(result.err, part)) << result.err;
    EXPECT_FALSE(std::filesystem::exists(scratch.path("x.csv")));
  };
  refused({"--scheme", "gauss-4"}, 2, "there  scheme    implicit-midpoint");
  refused({"--set", "eps=1"}, 2, "here   set       eps=1");
  refused({"--plain-sums"}, 2, "code      sha256");
  EXPECT_EQ(hamgen(and_more(run.words(), {"--resume", scratch.path("c")})).status, 2);  // no rows
  EXPECT_EQ(hamgen(and_more(run.words(), {"--checkpoint", scratch.path("c")})).status, 2);
  EXPECT_EQ(
      hamgen(and_more(run.words(), {"--interpret", "--checkpoint", scratch.path("d")})).status, 2);
  EXPECT_EQ(hamgen(and_more(run.words(), {"--every-seconds", "1"})).status, 2);
  EXPECT_EQ(hamgen(and_more(run.words(), {"--resume", scratch.path("none")})).status, 4);
  const auto put = [&](const std::string& text) {
    std::ofstream(scratch.path("c"), std::ios::binary) << text;
  };
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{19}, std::size_t{25}, good.size() / 2, good.size() - 1}) {
    put(good.substr(0, size));
    refused({}, 4, "cannot go on from");
  }
  std::string changed = good;
  changed[good.size() / 2] = static_cast<char>(changed[good.size() / 2] ^ 1);
  put(changed);
  refused({}, 4, "its checksum is another");
  put("hamgen checkpoint 9\n" + good.substr(20));
  refused({}, 4, "its format is 'hamgen checkpoint 9'");
  put(good + "x");
  refused({}, 4, "cannot go on from");
  put(good);
  const std::string rows = read(scratch.path("x.csv.part"));
  std::ofstream(scratch.path("x.csv.part")) << rows.substr(0, rows.size() / 2);
  refused({}, 4, "does not begin with the");
  std::ofstream(scratch.path("x.csv.part")) << rows;
  const Result result = hamgen(run.command());
  EXPECT_EQ(result.status, 0) << result.err;
  run.expect_the_same(result.out);
}

}  // namespace
}  // namespace hamgen::app_test
