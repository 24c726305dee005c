// Every command of README and docs/ is run, and what it prints is what the page shows.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/page_examples.hpp"

namespace hamgen::app_test {
namespace {

const std::string docs = HAMGEN_SOURCE_DIR "/docs/";

// The pages with tests of their own in readme_test.cpp.
const std::set<std::string> with_own_tests = {"plugin.md"};
// The others with commands, and how many at least.
const std::map<std::string, std::size_t> pages = {
    {"batch.md", 1},          {"certificates.md", 3}, {"command.md", 4}, {"ensemble.md", 4},
    {"gallery.md", 12},       {"scaling.md", 2},      {"studies.md", 9}, {"tutorial.md", 12},
    {"specialisation.md", 2}, {"verification.md", 12}};

TEST(Pages, WithCommandsAreAllRun) {
  for (const auto& entry : std::filesystem::directory_iterator(docs)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".md" || with_own_tests.contains(name)) continue;
    const std::size_t commands = number_of_commands(entry.path().string());
    EXPECT_EQ(commands > 0, pages.contains(name)) << name;
    if (pages.contains(name)) EXPECT_GE(commands, pages.at(name)) << name;
  }
}

// A block with a command that is not run is the synopsis of one, with MODEL or FILE in it, or one
// of these: of days, of many machines, of a run that is interrupted (which other tests do).
TEST(Pages, HaveNoCommandThatIsOnlyShown) {
  const std::set<std::string> known = {
      "hamgen run hamiltonians/pendulum.ham --steps 1e11 --every 1e6 -o pendulum.csv --checkpoint "
      "pendulum.checkpoint",
      "$ hamgen ensemble pendulum.ham --over q=0:3:10000 --seed 3 --random 'p=normal(0,1)' -o "
      "x.csv --resume"};
  std::vector<std::string> all = {HAMGEN_SOURCE_DIR "/README.md"};
  for (const auto& [name, commands] : pages) all.push_back(docs + name);
  for (const std::string& page : all) {
    for (const SilentBlock& block : silent_blocks(page)) {
      const bool is_synopsis = contains(block.first, " MODEL") || contains(block.first, " FILE");
      EXPECT_TRUE(is_synopsis || known.contains(block.first)) << page << ": " << block.first;
    }
  }
}

// The pictures of the gallery are those that its commands draw.
void expect_pictures(const Scratch& scratch) {
  std::set<std::string> drawn;
  std::set<std::string> shown;
  for (const std::string& name : scratch.names()) {
    if (name.ends_with(".png")) drawn.insert(name);
  }
  for (const auto& entry : std::filesystem::directory_iterator(docs + "gallery")) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".png")) continue;
    shown.insert(name);
    EXPECT_TRUE(contains(read(docs + "gallery.md"), "](gallery/" + name + ")")) << name;
  }
  EXPECT_EQ(drawn, shown);
}

class PagesLong : public testing::TestWithParam<std::string> {};

TEST_P(PagesLong, ShowWhatTheCommandsPrint) {
  const std::string page = docs + GetParam();
  const Scratch scratch;
  lay_out(page, scratch);
  if (GetParam() == "tutorial.md") scratch.write("galaxy.ham", read(docs + "tutorial/galaxy.ham"));
  expect_page_is_true(page, scratch.path("."), 0);
  expect_commands_work(page, scratch.path("."));
  if (GetParam() == "gallery.md") expect_pictures(scratch);
}

std::vector<std::string> names_of_pages() {
  std::vector<std::string> names;
  for (const auto& [name, commands] : pages) names.push_back(name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Docs, PagesLong, testing::ValuesIn(names_of_pages()),
                         [](const auto& info) {
                           return info.param.substr(0, info.param.find('.'));
                         });

}  // namespace
}  // namespace hamgen::app_test
