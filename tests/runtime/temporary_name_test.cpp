#include "runtime/temporary_name.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "runtime/atomic_file.hpp"
#include "tests/runtime/oscillator.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;
using tests::write_text;

// The tag of a process of this machine that was, and is no more.
std::string dead_tag() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  int status = 0;
  ::waitpid(child, &status, 0);
  std::string tag = process_tag();
  const std::string own = std::to_string(::getpid());
  return tag.replace(tag.rfind(own + "-"), own.size(), std::to_string(child));
}

TEST(TemporaryName, TellsTheDeadFromTheLivingAndFromOtherMachines) {
  EXPECT_TRUE(is_tag_of_the_dead(dead_tag()));
  EXPECT_TRUE(is_tag_of_the_dead(dead_tag() + "12345678.tmp"));
  EXPECT_FALSE(is_tag_of_the_dead(process_tag()));
  EXPECT_FALSE(is_tag_of_the_dead("x" + dead_tag()));
  const std::string dead = dead_tag();
  EXPECT_FALSE(is_tag_of_the_dead(dead.substr(0, dead.size() - 1)));
  for (const char* tag : {"", "-", "--", "0-", "-1-", "99999999999999999999-"})
    EXPECT_FALSE(is_tag_of_the_dead(tag)) << tag;
}

TEST(TemporaryName, CollectsWhatDeadProcessesLeftBesideTheSameFile) {
  const TemporaryDirectory directory = private_directory();
  const fs::path file = directory.path() / "x.csv";
  const std::string dead = ".x.csv." + dead_tag() + "0123abcd.tmp";
  const std::string alive = ".x.csv." + process_tag() + "0123abcd.tmp";
  const std::string elsewhere = ".x.csv.other-1-0123abcd.tmp";
  const std::string other_file = ".y.csv." + dead_tag() + "0123abcd.tmp";
  for (const std::string& name : {dead, alive, elsewhere, other_file})
    write_text(directory.path() / name, "left over");
  {
    AtomicFile target(file);
    EXPECT_FALSE(fs::exists(directory.path() / dead));
    for (const std::string& name : {alive, elsewhere, other_file})
      EXPECT_TRUE(fs::exists(directory.path() / name)) << name;
    target.write("done");
    target.publish();
  }
  EXPECT_EQ(tests::text_of(file), "done");
  EXPECT_EQ(tests::count_entries(directory.path()), 4u);
}

TEST(TemporaryDirectory, CollectsThoseOfDeadProcesses) {
  const TemporaryDirectory parent = private_directory();
  const fs::path dead = parent.path() / (".build-" + dead_tag() + "abcdef");
  const fs::path alive = parent.path() / (".build-" + process_tag() + "abcdef");
  for (const fs::path& path : {dead, alive}) {
    fs::create_directory(path);
    write_text(path / "plugin.cpp", "");
  }
  const TemporaryDirectory next(parent.path(), ".build-");
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(alive / "plugin.cpp"));
  EXPECT_TRUE(next.path().filename().string().starts_with(".build-" + process_tag()));
}

TEST(TemporaryName, FitsWhereALongNameFits) {
  const TemporaryDirectory directory = private_directory();
  const fs::path file = directory.path() / std::string(255, 'x');
  EXPECT_TRUE(atomic_write(file, "text"));
  EXPECT_LE(temporary_name(file).filename().string().size(), 255u);
}

}  // namespace
}  // namespace hamgen::runtime
