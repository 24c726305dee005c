// The commands of the pages of benchmarks/, most of which take too long to be run by a test: the
// presets, the targets and the options are there.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

const std::string root = HAMGEN_SOURCE_DIR;

// The programs, and the folder of benchmarks/ that has the sources of each.
const std::map<std::string, std::string> programs = {
    {"step_benchmark", "step"},     {"peers_benchmark", "peers"}, {"cost_benchmark", "cost"},
    {"lanes_benchmark", "lanes"},   {"batch", "batch"},           {"drift", "drift"},
    {"contract_table", "contract"}, {"rounding", "rounding"}};

// The lines of its blocks, and what stands between grave accents in its sentences.
void add_commands(const std::string& page, std::vector<std::string>& commands) {
  bool inside = false;
  for (std::string line : lines(read(page))) {
    if (line.starts_with("```")) {
      inside = !inside;
    } else if (inside) {
      commands.push_back(line.substr(0, line.find(" #")));
    } else {
      const std::regex quoted("`([^`]+)`");
      for (std::sregex_iterator it(line.begin(), line.end(), quoted), end; it != end; ++it)
        commands.push_back((*it)[1]);
    }
  }
}
std::vector<std::string> commands_of_pages() {
  std::vector<std::string> commands;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root + "/benchmarks")) {
    if (entry.path().filename() == "README.md") add_commands(entry.path().string(), commands);
  }
  return commands;
}

std::vector<std::string> words_of(const std::string& command) {
  std::istringstream stream(command);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::string sources_of(const std::string& program) {
  std::string text;
  for (const auto& entry :
       std::filesystem::directory_iterator(root + "/benchmarks/" + programs.at(program)))
    text += read(entry.path().string());
  return text;
}

// A word of CMake's list of the benchmarks.
bool is_target(const std::string& name) {
  return std::regex_search(read(root + "/benchmarks/CMakeLists.txt"),
                           std::regex("\\b" + name + "\\b"));
}

void expect_cmake_works(const std::vector<std::string>& words) {
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    if (words[i] == "--preset") {
      EXPECT_TRUE(contains(read(root + "/CMakePresets.json"), "\"name\": \"" + words[i + 1] + "\""))
          << words[i + 1];
    }
    if (words[i] == "--target") {
      EXPECT_TRUE(is_target(words[i + 1])) << words[i + 1];
    }
  }
}

// Those of Google Benchmark are not in the sources.
void expect_options_are_there(const std::string& program, const std::vector<std::string>& words) {
  const std::string sources = sources_of(program);
  for (const std::string& word : words) {
    if (!word.starts_with("--") || word.starts_with("--benchmark_")) continue;
    EXPECT_TRUE(contains(sources, "\"" + word + "\"")) << program << " " << word;
  }
}

TEST(BenchmarkPages, NameWhatIsThere) {
  std::set<std::string> seen;
  std::size_t builds = 0;
  for (const std::string& command : commands_of_pages()) {
    const std::vector<std::string> words = words_of(command);
    if (words.empty()) continue;
    const std::string program = std::filesystem::path(words.front()).filename();
    if (program == "cmake") {
      expect_cmake_works(words);
      ++builds;
    }
    if (!programs.contains(program)) {
      EXPECT_FALSE(words.front().starts_with("build/release/bin/")) << command;
      continue;
    }
    EXPECT_TRUE(is_target(program)) << program;
    expect_options_are_there(program, words);
    seen.insert(program);
  }
  EXPECT_EQ(seen.size(), programs.size());
  EXPECT_GE(builds, 4u);
}

}  // namespace
}  // namespace hamgen::app_test
