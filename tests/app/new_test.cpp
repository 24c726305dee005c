// A model to begin with.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

namespace fs = std::filesystem;

TEST(New, WritesAModelThatRuns) {
  const fs::path path = fs::temp_directory_path() / "hamgen_new_model.ham";
  fs::remove(path);
  const std::string name = (fs::temp_directory_path() / "hamgen_new_model").string();
  // A name, and no path.
  EXPECT_EQ(hamgen({"new", name}).status, 2);
  EXPECT_EQ(hamgen({"new", "2nd"}).status, 2);
  const fs::path here = fs::current_path();
  fs::current_path(fs::temp_directory_path());
  const Result made = hamgen({"new", "hamgen_new_model"});
  const Result again = hamgen({"new", "hamgen_new_model"});
  fs::current_path(here);
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(made.out, "hamgen_new_model.ham\n");
  EXPECT_EQ(again.status, 2);
  EXPECT_TRUE(contains(again.err, "is there already")) << again.err;
  const Result check = hamgen({"check", path.string()});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_EQ(check.err, "");
  const Result run = hamgen({"run", path.string(), "--interpret", "--steps", "50"});
  EXPECT_EQ(run.status, 0) << run.err;
  fs::remove(path);
}

TEST(Help, IsThereUnderEveryNameItIsAskedBy) {
  const std::string whole = hamgen({"--help"}).out;
  EXPECT_EQ(hamgen({"-h"}).out, whole);
  EXPECT_EQ(hamgen({"help"}).out, whole);
  const std::string of_run = hamgen({"run", "--help"}).out;
  EXPECT_NE(of_run, whole);
  EXPECT_EQ(hamgen({"help", "run"}).out, of_run);
  EXPECT_EQ(hamgen({"run", "-h"}).out, of_run);
}

}  // namespace
}  // namespace hamgen::app_test
