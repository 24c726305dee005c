// The lines of a summary.
#include "app/output/summary_entry.hpp"

#include <gtest/gtest.h>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

TEST(SummaryEntry, KeepsANameWithItsValue) {
  std::string text = "t = 200:";
  for (int i = 1; i < 12; ++i) text += " q[" + std::to_string(i) + "] = 0.4062269006620052,";
  const std::vector<std::string> wrapped = lines(app::summary_entry("last state", text));
  EXPECT_GT(wrapped.size(), 2U);
  for (const std::string& line : wrapped) {
    EXPECT_LE(line.size(), app::summary_width);
    EXPECT_FALSE(line.ends_with('=') || line.ends_with(']')) << line;
  }
  EXPECT_EQ(app::summary_entry("energy", "a = 1; b"), "  energy      a = 1; b\n");
}

}  // namespace
}  // namespace hamgen::app_test
