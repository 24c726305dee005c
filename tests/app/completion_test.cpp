// What the installation makes of the command's own definition.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>

#include "runtime/process.hpp"
#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

namespace fs = std::filesystem;

// What bash proposes for the last of these words.
std::vector<std::string> completed(const std::vector<std::string>& typed) {
  const fs::path path = fs::temp_directory_path() / "hamgen_completion_test.bash";
  std::ofstream file(path);
  file << hamgen({"completion", "bash"}).out << "COMP_WORDS=(hamgen";
  for (const std::string& word : typed) file << " '" << word << "'";
  file << ")\nCOMP_CWORD=" << typed.size() << "\n_hamgen\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
  file.close();
  const runtime::ProcessResult result = runtime::run_process({.command = {"bash", path.string()}});
  fs::remove(path);
  EXPECT_TRUE(result.succeeded()) << result.output;
  return lines(result.output);
}

TEST(Completion, ProposesCommandsOptionsAndNames) {
  EXPECT_EQ(completed({"che"}), std::vector<std::string>{"check"});
  EXPECT_EQ(completed({"help", "tun"}), std::vector<std::string>{"tune"});
  EXPECT_EQ(completed({"generate", "a.ham", "--watch"}),
            std::vector<std::string>{"--watch-modified"});
  EXPECT_EQ(completed({"run", "a.ham", "--scheme", "gauss-1"}),
            (std::vector<std::string>{"gauss-10", "gauss-12", "gauss-14", "gauss-16"}));
  EXPECT_EQ(completed({"run", "a.ham", "--scheme", "=", "stormer"}),
            std::vector<std::string>{"stormer-verlet"});
  EXPECT_EQ(completed({"cache", "p"}), std::vector<std::string>{"prune"});
  EXPECT_EQ(completed({"chaos", "a.ham", "--indicator", "m"}), std::vector<std::string>{"megno"});
  EXPECT_EQ(completed({"run", HAMGEN_SOURCE_DIR "/README"}), std::vector<std::string>{""});
  EXPECT_EQ(completed({"run", "a.ham", "--plot", HAMGEN_SOURCE_DIR "/README"}),
            std::vector<std::string>{HAMGEN_SOURCE_DIR "/README.md"});
  EXPECT_EQ(hamgen({"completion", "fish"}).status, 2);
}

// What zsh proposes at the end of each of these lines, in the alphabet's order.
std::vector<std::vector<std::string>> completed_by_zsh(const std::vector<std::string>& typed) {
  const Scratch scratch;
  runtime::ProcessRequest request;
  request.command = {"zsh", "-f", HAMGEN_SOURCE_DIR "/tests/app/completion.zsh",
                     scratch.write("_hamgen", hamgen({"completion", "zsh"}).out)};
  request.command.insert(request.command.end(), typed.begin(), typed.end());
  const runtime::ProcessResult result = runtime::run_process(request);
  EXPECT_TRUE(result.succeeded()) << result.output;
  std::vector<std::vector<std::string>> all(1);
  for (const std::string& line : lines(result.output)) {
    if (line == ".") {
      std::ranges::sort(all.back());
      all.emplace_back();
    } else {
      all.back().push_back(line);
    }
  }
  all.pop_back();
  return all;
}

TEST(Completion, ProposesTheSameInBothShells) {
  const std::vector<std::vector<std::string>> typed = {
      {"che"},
      {""},
      {"-"},
      {"help", "tun"},
      {"check", "a.ham", "--"},
      {"generate", "a.ham", "--watch"},
      {"run", "a.ham", "--scheme", "gauss-1"},
      {"chaos", "a.ham", "--indicator", "m"},
      {"show", "a.ham", "--stage", "p"},
      {"cache", "p"},
      {"list", ""},
      {"run", "a.ham", "--plot", HAMGEN_SOURCE_DIR "/README"}};
  std::vector<std::string> typed_lines;
  for (const std::vector<std::string>& words : typed)
    typed_lines.push_back(fmt::format("hamgen {}", fmt::join(words, " ")));
  const auto by_zsh = completed_by_zsh(typed_lines);
  ASSERT_EQ(by_zsh.size(), typed.size());
  for (std::size_t i = 0; i < typed.size(); ++i) {
    std::vector<std::string> by_bash = completed(typed[i]);
    // At the beginning bash proposes the options beside the commands, zsh once a minus is typed.
    if (typed[i] == std::vector<std::string>{""})
      std::erase_if(by_bash, [](const std::string& word) { return word.starts_with('-'); });
    for (std::string& word : by_bash) word = fs::path(word).filename().string();
    std::ranges::sort(by_bash);
    EXPECT_EQ(by_zsh[i], by_bash) << typed_lines[i];
  }
  EXPECT_EQ(completed_by_zsh({"hamgen run a.ham --scheme=stormer"})[0],
            std::vector<std::string>{"stormer-verlet"});
}

TEST(Completion, AndManualNameEveryCommandAndNoHiddenOne) {
  const std::string help = hamgen({"--help"}).out;
  const std::string manual = hamgen({"man"}).out;
  const std::string zsh = hamgen({"completion", "zsh"}).out;
  EXPECT_FALSE(contains(help, "completion"));
  for (const char* command : {"new", "check", "run", "section", "plugin", "cache"}) {
    EXPECT_TRUE(contains(manual, std::string(".SS hamgen ") + command + "\n")) << command;
    EXPECT_TRUE(contains(zsh, std::string("    '") + command + ":")) << command;
  }
  EXPECT_TRUE(contains(manual, "\\-\\-watch\\-modified K\n")) << manual;
  EXPECT_FALSE(contains(manual, ".SS hamgen man"));
}

// Every option of every help is in each of them.
TEST(Completion, AndManualHaveEveryOption) {
  const std::string manual = hamgen({"man"}).out;
  const std::string zsh = hamgen({"completion", "zsh"}).out;
  const std::string bash = hamgen({"completion", "bash"}).out;
  const std::regex named("--[a-z-]+");
  std::size_t options = 0;
  for (const char* command : {"check", "generate", "run", "bench", "stress", "section", "list"}) {
    const std::string begin = std::string("\n.SS hamgen ") + command + "\n";
    ASSERT_TRUE(contains(manual, begin));
    const std::size_t from = manual.find(begin) + begin.size();
    const std::string page = manual.substr(from, manual.find("\n.S", from) - from);
    const std::size_t zsh_from = zsh.find(std::string("\n    ") + command + ") _arguments");
    const std::string zsh_part = zsh.substr(zsh_from, zsh.find(";;", zsh_from) - zsh_from);
    const std::size_t bash_from = bash.find(std::string("\n    ") + command + ") words=\"");
    const std::string bash_part = bash.substr(bash_from, bash.find(";;", bash_from) - bash_from);
    for (const std::string& line : lines(hamgen({command, "--help"}).out)) {
      const std::string left = line.substr(0, line.find("  ", 3));
      if (!line.starts_with("  -")) continue;
      for (std::sregex_iterator it(left.begin(), left.end(), named), end; it != end; ++it) {
        const std::string option = it->str();
        EXPECT_TRUE(contains(page, std::regex_replace(option, std::regex("-"), "\\-")))
            << command << ' ' << option;
        EXPECT_TRUE(contains(zsh_part, "'" + option)) << command << ' ' << option;
        EXPECT_TRUE(contains(bash_part, option)) << command << ' ' << option;
        ++options;
      }
    }
  }
  EXPECT_GE(options, 100u);
  EXPECT_TRUE(contains(zsh, "'-o["));
}

}  // namespace
}  // namespace hamgen::app_test
