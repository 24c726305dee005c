// What a page shows of commands, run and compared.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {

// Runs every "$ command" of the page's blocks marked `console` in the directory, with the shell and
// with this build's hamgen, and compares what it prints with what the page shows: numbers to a part
// in a thousand, "..." for any number of lines.  The page has at least so many of them.
void expect_page_is_true(const std::string& page, const std::string& directory, std::size_t least);

// What the commands of a page need: links to the folders of the sources that it names, and the
// models that it shows in blocks marked `ham`, each as its system's name says; main.cpp of its
// program.
void lay_out(const std::string& page, const Scratch& scratch);

// Runs every command of the page's blocks marked `sh`, in which a backslash continues a line; they
// succeed.
void expect_commands_work(const std::string& page, const std::string& directory);

// How many commands the page shows in blocks marked `console` and `sh`.
[[nodiscard]] std::size_t number_of_commands(const std::string& page);

// What stands between two lines of three ticks.
struct PageBlock {
  std::string mark;  // behind the first three
  std::vector<std::string> lines;

  [[nodiscard]] std::string text() const;
  // The first line; empty of an empty block.
  [[nodiscard]] std::string first() const;
};
[[nodiscard]] std::vector<PageBlock> blocks_of_page(const std::string& page);

}  // namespace hamgen::app_test
