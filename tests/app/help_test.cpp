#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

const std::vector<std::string> commands = {
    "new",    "check",   "show",    "generate", "run",  "bench",    "report", "stress", "tune",
    "verify", "certify", "section", "chaos",    "plot", "ensemble", "plugin", "list",   "cache"};

// A screen is 24 lines of 100 columns.
void expect_one_screen(const std::vector<std::string>& arguments) {
  const Result result = hamgen(arguments);
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "");
  const std::vector<std::string> text = lines(result.out);
  EXPECT_GE(text.size(), 3u);
  EXPECT_LE(text.size(), 24u) << result.out;
  for (const std::string& line : text) EXPECT_LE(line.size(), 100u) << line;
}

TEST(Help, FitsOneScreenForEveryCommand) {
  expect_one_screen({"--help"});
  for (const std::string& command : commands) expect_one_screen({command, "--help"});
}

TEST(Help, NamesEveryCommand) {
  const Result result = hamgen({"--help"});
  for (const std::string& command : commands)
    EXPECT_TRUE(contains(result.out, "\n  " + command + " ")) << result.out;
}

// The tables of README and of the command's page.
TEST(Help, HasTheCommandsOfThePages) {
  const std::string help = hamgen({"--help"}).out;
  const std::regex row("\n\\| `hamgen ([a-z]+)[^`]*` \\|");
  for (const char* page : {"/README.md", "/docs/command.md"}) {
    const std::string text = read(std::string(HAMGEN_SOURCE_DIR) + page);
    std::set<std::string> rows;
    for (std::sregex_iterator it(text.begin(), text.end(), row), end; it != end; ++it)
      rows.insert((*it)[1]);
    EXPECT_EQ(rows, std::set<std::string>(commands.begin(), commands.end())) << page;
  }
  std::size_t listed = 0;
  for (const std::string& line : lines(help))
    listed += static_cast<std::size_t>(std::regex_match(line, std::regex("  [a-z]+ +[a-zA-Z].*")));
  EXPECT_EQ(listed, commands.size()) << help;
}

TEST(Help, TellsTheVersion) {
  const Result result = hamgen({"--version"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out, "hamgen 0.1.0\n");
}

TEST(Help, IsThereHoweverOneAsks) {
  const std::string own = hamgen({"run", "--help"}).out;
  EXPECT_EQ(hamgen({"help", "run"}).out, own);
  EXPECT_EQ(hamgen({"run", "-h"}).out, own);
  EXPECT_EQ(hamgen({"help", "help"}).out, hamgen({"--help"}).out);
  for (const std::string& command : commands)
    EXPECT_EQ(hamgen({command, "--version"}).out, "hamgen 0.1.0\n");
}

void expect_usage_error(const std::vector<std::string>& arguments, std::string_view part) {
  const Result result = hamgen(arguments);
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(contains(result.err, part)) << result.err;
}

TEST(Usage, IsSaidWithAWayOut) {
  expect_usage_error({}, "hamgen --help");
  expect_usage_error({"rum"}, "did you mean 'run'?");
  expect_usage_error({"run"}, "MODEL is required");
  expect_usage_error({"run", "a.ham", "--bets=1"}, "did you mean '--beta'?");
  expect_usage_error({"run", "a.ham", "b.ham"}, "unexpected 'b.ham'");
  expect_usage_error({"run", "--alpha=", "a.ham"}, "--alpha= has no value");
  expect_usage_error({"run", "no_such_file.ham"}, "no_such_file.ham");
  expect_usage_error({"list", "scheme"}, "functions, schemes, solvers and formats");
  expect_usage_error({"help", "rum"}, "did you mean 'run'?");
  expect_usage_error({"cache", "burn"}, "list, clear and prune");
}

}  // namespace
}  // namespace hamgen::app_test
