#include "tests/app/page_examples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <sstream>
#include <vector>

namespace hamgen::app_test {
namespace {

struct Example {
  std::string command;
  std::vector<std::string> output;  // "..." stands for any number of lines
};

std::vector<PageBlock> blocks_of(const std::string& text) {
  std::vector<PageBlock> blocks;
  bool inside = false;
  for (const std::string& line : lines(text)) {
    const std::size_t fence = line.find_first_not_of(' ');
    if (fence != std::string::npos && line.compare(fence, 3, "```") == 0) {
      inside = !inside;
      if (inside) blocks.push_back({line.substr(fence + 3), {}});
    } else if (inside) {
      blocks.back().lines.push_back(line);
    }
  }
  return blocks;
}

// Of the blocks marked `console`; a line that begins with "$ " starts an example.
std::vector<Example> examples(const std::string& text) {
  std::vector<Example> result;
  for (const PageBlock& block : blocks_of(text)) {
    if (block.mark != "console") continue;
    for (const std::string& line : block.lines) {
      if (line.starts_with("$ ")) {
        result.push_back({line.substr(2), {}});
      } else if (!result.empty()) {
        result.back().output.push_back(line);
      }
    }
  }
  return result;
}

// Of the blocks marked `sh`.
std::vector<std::string> shell_commands(const std::string& text) {
  std::vector<std::string> commands;
  for (const PageBlock& block : blocks_of(text)) {
    bool goes_on = false;
    for (const std::string& line : block.lines) {
      if (block.mark != "sh") continue;
      if (!goes_on) commands.emplace_back();
      goes_on = line.ends_with('\\');
      commands.back() += goes_on ? line.substr(0, line.size() - 1) : line;
    }
  }
  return commands;
}

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

std::vector<std::string> rendered_cells(std::string line) {
  std::ranges::replace(line, ',', ' ');
  return words(line);
}

// Equal words, numbers to a part in a thousand: the last digits depend on the mathematics library,
// and an energy error of the size of round-off on all of them.
bool agrees(const std::string& shown, const std::string& printed) {
  if (shown == printed) return true;
  char* end_shown = nullptr;
  char* end_printed = nullptr;
  const double a = std::strtod(shown.c_str(), &end_shown);
  const double b = std::strtod(printed.c_str(), &end_printed);
  if (end_shown == shown.c_str() || std::string(end_shown) != end_printed) return false;
  return std::fabs(a - b) <= 1e-3 * std::fabs(a) + 1e-12;
}

bool line_agrees(const std::string& shown, const std::string& printed) {
  if (shown == printed) return true;
  const std::vector<std::string> left = rendered_cells(shown);
  const std::vector<std::string> right = rendered_cells(printed);
  // Times are nobody's promise.
  if (!left.empty() && !right.empty() && left[0] == "time") return right[0] == "time";
  return std::equal(left.begin(), left.end(), right.begin(), right.end(), agrees);
}

bool output_agrees(std::span<const std::string> shown, std::span<const std::string> printed) {
  if (shown.empty()) return printed.empty();
  if (shown[0] == "...") {
    for (std::size_t skipped = 0; skipped <= printed.size(); ++skipped) {
      if (output_agrees(shown.subspan(1), printed.subspan(skipped))) return true;
    }
    return false;
  }
  return !printed.empty() && line_agrees(shown[0], printed[0]) &&
         output_agrees(shown.subspan(1), printed.subspan(1));
}

}  // namespace

void expect_page_is_true(const std::string& page, const std::string& directory, std::size_t least) {
  const std::vector<Example> all = examples(read(page));
  ASSERT_GE(all.size(), least);
  for (const Example& example : all) {
    const Result result = shell(example.command, directory);
    std::vector<std::string> printed = lines(result.out + result.err);
    // How far work is that takes long on this machine.
    std::erase_if(printed, [](const std::string& line) {
      return line.starts_with("hamgen: ") && line.ends_with(" left");
    });
    EXPECT_TRUE(output_agrees(example.output, printed)) << "$ " << example.command << '\n'
                                                        << result.out << result.err;
  }
}

void lay_out(const std::string& page, const Scratch& scratch) {
  for (const char* folder : {"hamiltonians", "generated", "docs", "scripts", "tests"})
    std::filesystem::create_directory_symlink(HAMGEN_SOURCE_DIR + std::string("/") + folder,
                                              scratch.path(folder));
  for (const PageBlock& block : blocks_of(read(page))) {
    std::string system;
    const std::string text = block.text();
    for (const std::string& line : block.lines) {
      if (line.starts_with("system ")) system = words(line)[1];
    }
    if (block.mark == "ham" && !system.empty()) scratch.write(system + ".ham", text);
    if (block.mark == "cpp" && contains(text, "int main()")) scratch.write("main.cpp", text);
  }
}

void expect_commands_work(const std::string& page, const std::string& directory) {
  for (const std::string& command : shell_commands(read(page))) {
    const Result result = shell(command, directory);
    EXPECT_EQ(result.status, 0) << "$ " << command << '\n' << result.out << result.err;
  }
}

std::size_t number_of_commands(const std::string& page) {
  return examples(read(page)).size() + shell_commands(read(page)).size();
}

std::string PageBlock::text() const {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string PageBlock::first() const { return lines.empty() ? "" : lines.front(); }

std::vector<PageBlock> blocks_of_page(const std::string& page) { return blocks_of(read(page)); }

}  // namespace hamgen::app_test
