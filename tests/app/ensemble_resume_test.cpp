// hamgen ensemble --resume: whatever ended a command, the next ones do exactly what is missing.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <random>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

// 40 records of 256 trajectories.
std::vector<std::string> command(const Scratch& scratch, const std::string& output) {
  return {"ensemble",
          scratch.path("pendulum.ham"),
          "--quiet",
          "--over",
          "q=0:3:10000",
          "--steps",
          "50",
          "--random",
          "p=normal(0,0.1)",
          "--statistics",
          "energy",
          "--every",
          "10",
          "-o",
          scratch.path(output)};
}

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// The bytes of a command that nothing interrupts.
std::string uninterrupted(const Scratch& scratch) {
  scratch.write("pendulum.ham", pendulum);
  const Result result = hamgen(command(scratch, "whole.csv"));
  EXPECT_EQ(result.status, 0) << result.err;
  return read(scratch.path("whole.csv"));
}

std::string part_of(const Scratch& scratch) { return scratch.path("x.csv.parts") + "/part-000000"; }

// Leaves what is done after so many records and the half of another.
void kill_at(const Scratch& scratch, int record) {
  // Two places are passed by the manifest.
  const Result result = hamgen(with(command(scratch, "x.csv"), {"--threads", "1"}),
                               {"HAMGEN_KILL_POINT=" + std::to_string(record + 2)});
  EXPECT_EQ(result.status, 128 + SIGKILL) << result.err;
}

TEST(EnsembleResume, GoesOnAfterKillsAtEveryKindOfPlace) {
  const Scratch scratch;
  const std::string whole = uninterrupted(scratch);
  // One record is written by each command, and the next one in half.
  int kills = 0;
  for (int status = -1; status != 0 && kills < 200;) {
    const Result result = hamgen(with(command(scratch, "x.csv"), {"--resume"}),
                                 {"HAMGEN_KILL_POINT=" + std::to_string(kills % 3 + 1)});
    status = result.status;
    if (status == 0) break;
    ASSERT_EQ(status, 128 + SIGKILL) << result.err;
    ++kills;
  }
  EXPECT_GE(kills, 20);
  EXPECT_LT(kills, 200);
  EXPECT_EQ(read(scratch.path("x.csv")), whole);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"pendulum.ham", "whole.csv", "x.csv"}));
}

// Kills at random moments, until so many have met it at work.
void kill_often(int kills) {
  const Scratch scratch;
  const std::string whole = uninterrupted(scratch);
  std::mt19937 random(1);
  int met = 0;
  while (met < kills) {
    const int status = status_if_killed(with(command(scratch, "x.csv"), {"--resume"}),
                                        std::chrono::microseconds(random() % 150000));
    met += status == 128 + SIGKILL ? 1 : 0;
    ASSERT_TRUE(status == 128 + SIGKILL || status == 0);
    if (std::filesystem::exists(scratch.path("x.csv"))) {
      // Whole, or not there; once in a while it begins anew.
      ASSERT_EQ(read(scratch.path("x.csv")), whole);
      std::filesystem::remove(scratch.path("x.csv"));
      std::filesystem::remove_all(scratch.path("x.csv.parts"));
    }
  }
  ASSERT_EQ(hamgen(with(command(scratch, "x.csv"), {"--resume"})).status, 0);
  EXPECT_EQ(read(scratch.path("x.csv")), whole);
}

TEST(EnsembleResume, GoesOnAfterTenKillsAtRandomMoments) { kill_often(10); }
TEST(EnsembleResumeLong, GoesOnAfterTwoHundredKillsAtRandomMoments) { kill_often(200); }

TEST(EnsembleResume, DoesNothingTwice) {
  const Scratch scratch;
  const std::string whole = uninterrupted(scratch);
  kill_at(scratch, 5);
  const std::string before = read(part_of(scratch));
  // Killed at the first record it writes: what was there stays as it is.
  EXPECT_EQ(hamgen(with(command(scratch, "x.csv"), {"--resume", "--threads", "1"}),
                   {"HAMGEN_KILL_POINT=1"})
                .status,
            128 + SIGKILL);
  const std::string after = read(part_of(scratch));
  ASSERT_GE(after.size(), before.size() / 6 * 5);
  EXPECT_EQ(after, before);  // four records, and the same half of the fifth
  EXPECT_EQ(hamgen(with(command(scratch, "x.csv"), {"--resume"})).status, 0);
  EXPECT_EQ(read(scratch.path("x.csv")), whole);
  const Result again = hamgen({"ensemble", scratch.path("pendulum.ham"), "--over", "q=0:3:10000",
                               "--steps", "50", "--random", "p=normal(0,0.1)", "--statistics",
                               "energy", "--every", "10", "-o", scratch.path("x.csv"), "--resume"});
  EXPECT_EQ(again.status, 0);
  EXPECT_TRUE(contains(again.err, "nothing is missing")) << again.err;
}

TEST(EnsembleResume, DoesNotTakeACutFileForAWholeOne) {
  const Scratch scratch;
  const std::string whole = uninterrupted(scratch);
  for (const std::size_t size : {whole.size() / 3, whole.rfind("# ended"), whole.size() - 1}) {
    std::ofstream(scratch.path("x.csv"), std::ios::binary) << whole.substr(0, size);
    const Result result = hamgen(with(command(scratch, "x.csv"), {"--resume"}));
    EXPECT_EQ(result.status, 2) << size;
    EXPECT_TRUE(contains(result.err, "is cut off")) << result.err;
  }
}

TEST(EnsembleResume, DoesSpoiltRecordsAgain) {
  const Scratch scratch;
  const std::string whole = uninterrupted(scratch);
  kill_at(scratch, 5);
  std::string part = read(part_of(scratch));
  for (const std::size_t at : {part.size() / 10, part.size() / 3, part.size() - 7})
    part[at] = static_cast<char>(part[at] ^ 16);
  std::ofstream(part_of(scratch), std::ios::binary) << part;
  EXPECT_EQ(hamgen(with(command(scratch, "x.csv"), {"--resume"})).status, 0);
  EXPECT_EQ(read(scratch.path("x.csv")), whole);
}

TEST(EnsembleResume, RefusesAnotherEnsembleAndSaysWhatDiffers) {
  const Scratch scratch;
  static_cast<void>(uninterrupted(scratch));
  kill_at(scratch, 3);
  const std::string before = read(part_of(scratch));
  const auto refused = [&](const std::vector<std::string>& words,
                           const std::vector<std::string>& parts) {
    const Result result = hamgen(words);
    EXPECT_EQ(result.status, 2) << result.err;
    for (const std::string& part : parts) EXPECT_TRUE(contains(result.err, part)) << result.err;
    EXPECT_EQ(read(part_of(scratch)), before);
  };
  const std::vector<std::string> same = command(scratch, "x.csv");
  refused(same, {"--resume goes on"});
  refused(with(same, {"--resume", "--scheme", "gauss-4"}),
          {"there  scheme    implicit-midpoint", "here   scheme    gauss-4"});
  refused(with(same, {"--resume", "--seed", "3"}), {"seed 0", "seed 3"});
  refused(with(same, {"--resume", "--h", "0.2"}), {"there  h         0.1"});
  refused(with(same, {"--resume", "--set", "eps=1"}), {"here   set       eps=1"});
  std::string manifest = read(scratch.path("x.csv.parts") + "/manifest");
  const std::string original = manifest;
  manifest.replace(manifest.find("hamgen 0."), 9, "hamgen 9.");
  std::ofstream(scratch.path("x.csv.parts") + "/manifest") << manifest;
  refused(with(same, {"--resume"}), {"there  made by   hamgen 9."});
  std::ofstream(scratch.path("x.csv.parts") + "/manifest") << original.substr(0, 50);
  refused(with(same, {"--resume"}), {"is of another ensemble"});
  // The model changes its text, and with it its digest.
  std::ofstream(scratch.path("x.csv.parts") + "/manifest") << original;
  scratch.write("pendulum.ham", std::string(pendulum) + "# one more line\n");
  refused(with(same, {"--resume"}), {"model     pendulum   sha256"});
}

TEST(EnsembleResume, LeavesADirectoryAloneThatIsNone) {
  const Scratch scratch;
  scratch.write("pendulum.ham", pendulum);
  std::filesystem::create_directory(scratch.path("x.csv.parts"));
  std::ofstream(scratch.path("x.csv.parts") + "/letter") << "dear";
  const Result result = hamgen(with(command(scratch, "x.csv"), {"--resume"}));
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "it has no manifest")) << result.err;
  EXPECT_EQ(read(scratch.path("x.csv.parts") + "/letter"), "dear");
}

}  // namespace
}  // namespace hamgen::app_test
