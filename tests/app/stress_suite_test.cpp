// scripts/stress-suite --quick: every scene runs, and no cell ends without a name.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <regex>

#include "runtime/process.hpp"
#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

TEST(StressSuite, NoCellEndsInANanAHangOrACrash) {
  const Scratch scratch;
  ::setenv("HAMGEN", HAMGEN_EXECUTABLE, 1);
  runtime::ProcessRequest request;
  request.command = {HAMGEN_SOURCE_DIR "/scripts/stress-suite", "--quick", scratch.path("docs")};
  request.time_limit = std::chrono::minutes(20);  // less than a cell has: one that hangs fails here
  const runtime::ProcessResult result = runtime::run_process(request);
  ASSERT_TRUE(result.succeeded()) << result.output;
  int maps = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scratch.path("docs"))) {
    if (entry.path().extension() != ".csv") continue;
    ++maps;
    const std::string text = read(entry.path().string());
    EXPECT_FALSE(std::regex_search(text, std::regex("[-,](nan|inf)"))) << entry.path();
    EXPECT_TRUE(std::filesystem::exists(scratch.path("docs/stability/") +
                                        entry.path().stem().string() + ".png"));
  }
  EXPECT_GE(maps, 15);
  const std::string page = read(scratch.path("docs/stability.md"));
  for (const char* part : {"spring_pendulum.ham", "stiff_fpu.ham", "wall.ham", "kepler.ham",
                           "near_separatrix", "--h 10", "henon_heiles.ham", "arenstorf.ham",
                           "pythagorean.ham", "magnetic.ham", "harmonic.ham"})
    EXPECT_TRUE(contains(page, part)) << part;
}

}  // namespace
}  // namespace hamgen::app_test
