// hamgen does without the libraries that take long to load, and hands over what needs them.
#include "app/whole_program.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using app::needs_whole_program;

const std::string kPendulumModel = HAMGEN_SOURCE_DIR "/hamiltonians/pendulum.ham";

TEST(WholeProgram, IsNeededForBallsAndForHdf5) {
  EXPECT_TRUE(needs_whole_program({"certify", "a.ham"}));
  EXPECT_TRUE(needs_whole_program({"run", "a.ham", "--certify"}));
  EXPECT_TRUE(needs_whole_program({"run", "a.ham", "--certify=100"}));
  EXPECT_TRUE(needs_whole_program({"ensemble", "a.ham", "-o", "a.h5"}));
  EXPECT_TRUE(needs_whole_program({"ensemble", "a.ham", "--output=a.hdf5"}));

  EXPECT_FALSE(needs_whole_program({}));
  EXPECT_FALSE(needs_whole_program({"--version"}));
  EXPECT_FALSE(needs_whole_program({"run", "a.ham", "-o", "a.h5"}));
  EXPECT_FALSE(needs_whole_program({"ensemble", "a.ham", "-o", "a.csv"}));
}

#ifdef HAMGEN_HAS_WHOLE

// What the dynamic loader would load for a program.
std::string libraries_of(const std::string& program) {
  return shell("LD_TRACE_LOADED_OBJECTS=1 " + program).out;
}

TEST(WholeProgram, AloneLoadsWhatTakesLong) {
  const std::string whole =
      std::filesystem::path(HAMGEN_EXECUTABLE).replace_filename("hamgen-whole");
  const std::string command = libraries_of(HAMGEN_EXECUTABLE);
  EXPECT_TRUE(contains(command, "libginac")) << command;
  EXPECT_FALSE(contains(command, "flint")) << command;
  EXPECT_FALSE(contains(command, "hdf5")) << command;
  const std::string all = libraries_of(whole);
  EXPECT_TRUE(contains(all, "flint") || contains(all, "hdf5")) << all;
}

TEST(WholeProgram, IsAskedForWhereItIsMissing) {
  const Scratch scratch;
  const std::string alone = scratch.path("hamgen");
  std::filesystem::copy_file(HAMGEN_EXECUTABLE, alone);
  for (const std::string& words : std::vector<std::string>{
           "certify " + kPendulumModel, "run --certify " + kPendulumModel,
           "ensemble " + kPendulumModel + " --over q=0:1:2 --steps 1 -o " + scratch.path("a.h5")}) {
    const Result result = shell(alone + " " + words);
    EXPECT_EQ(result.status, 4) << words;
    EXPECT_EQ(result.out, "") << words;
    EXPECT_EQ(result.err, "hamgen: " + scratch.path("hamgen-whole") +
                              " cannot be started: No such file or directory\n"
                              "help: this part of hamgen needs it; install or build hamgen again\n")
        << words;
  }
  EXPECT_EQ(scratch.names(), std::vector<std::string>{"hamgen"});
  EXPECT_EQ(shell(alone + " check " + kPendulumModel).status, 0);
}

#endif

}  // namespace
}  // namespace hamgen::app_test
