// The commands of the pages print what these say.
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/page_examples.hpp"

namespace hamgen::app_test {
namespace {

TEST(Readme, ShowsWhatTheCommandsPrint) {
  expect_page_is_true(HAMGEN_SOURCE_DIR "/README.md", HAMGEN_SOURCE_DIR, 5);
}

// The lines of the step are those of the checked-in header, together.
TEST(Readme, ShowsTheHeartOfTheEmittedStep) {
  const std::string page = read(HAMGEN_SOURCE_DIR "/README.md");
  const std::size_t begin = page.find("  for (int iteration = 1;; ++iteration) {");
  ASSERT_NE(begin, std::string::npos);
  const std::string shown = page.substr(begin, page.find("```", begin) - begin);
  EXPECT_GE(lines(shown).size(), 10u);
  EXPECT_TRUE(contains(read(HAMGEN_SOURCE_DIR "/generated/pendulum.hpp"), shown)) << shown;
}

// The model of the page is that of its folder, and its commands do what it says.
TEST(Tutorial, ShowsWhatTheCommandsPrint) {
  const Scratch scratch;
  const std::string model = read(HAMGEN_SOURCE_DIR "/docs/tutorial/galaxy.ham");
  const std::string page = read(HAMGEN_SOURCE_DIR "/docs/tutorial.md");
  const std::size_t system = model.find("system galaxy");
  const std::string shown = model.substr(system, model.find("scene plane") - system);
  EXPECT_TRUE(contains(page, shown));
  scratch.write("galaxy.ham", model);
  expect_page_is_true(HAMGEN_SOURCE_DIR "/docs/tutorial.md", scratch.path("."), 5);
}

// The programs of the page are those of its folder, and do what it says, in C and in Python.
TEST(PluginPage, ShowsWhatTheProgramsPrint) {
  const Scratch scratch;
  const std::string page = read(HAMGEN_SOURCE_DIR "/docs/plugin.md");
  for (const std::string name : {"orbit.c", "orbit.py"}) {
    const std::string program = read(HAMGEN_SOURCE_DIR "/docs/plugin/" + name);
    EXPECT_TRUE(contains(page, "\n" + program + "```")) << name;
    scratch.write(name, program);
  }
  scratch.write("kepler.ham", read(HAMGEN_SOURCE_DIR "/hamiltonians/kepler.ham"));
  expect_page_is_true(HAMGEN_SOURCE_DIR "/docs/plugin.md", scratch.path("."), 6);
}

// The table that the Python program declares is that of plugin.h: the same members, in their order.
TEST(PluginPage, DeclaresTheTableOfTheHeader) {
  const std::string header = read(HAMGEN_SOURCE_DIR "/runtime/plugin.h");
  const std::size_t begin = header.find("struct hamgen_plugin {");
  std::string table = header.substr(begin, header.find("\n};", begin) - begin);
  table = std::regex_replace(table, std::regex(R"(/\*[^*]*(\*(?!/)[^*]*)*\*/)"), "");
  std::vector<std::string> members;
  const std::regex member(R"((\(\*(\w+)\)\()|((\w+);))");
  for (std::sregex_iterator it(table.begin(), table.end(), member), end; it != end; ++it)
    members.push_back((*it)[2].matched ? (*it)[2] : (*it)[4]);
  const std::string program = read(HAMGEN_SOURCE_DIR "/docs/plugin/orbit.py");
  const std::size_t from = program.find("class Plugin(");
  const std::string fields = program.substr(from, program.find("def load", from) - from);
  std::vector<std::string> declared;
  const std::regex field(R"re(\("(\w+)",)re");
  for (std::sregex_iterator it(fields.begin(), fields.end(), field), end; it != end; ++it)
    declared.push_back((*it)[1]);
  EXPECT_EQ(members.size(), 28u);
  EXPECT_EQ(members, declared);
}

}  // namespace
}  // namespace hamgen::app_test
