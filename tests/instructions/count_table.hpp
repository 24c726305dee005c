// The file of counts: for each version of a compiler a block, its name and indented "COUNT STEP".
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/instructions/counted_steps.hpp"

namespace hamgen::instructions {

using CountTable = std::map<std::string, Counts>;  // by compiler and version: "g++ 12.2.0"

[[nodiscard]] CountTable read_table(const std::filesystem::path& path);
// Comments of the file are kept.
void write_table(const std::filesystem::path& path, const CountTable& table);

// What differs by more than 3 parts in 100, or is in one of them only: a line each.
[[nodiscard]] std::vector<std::string> differences(const Counts& counted, const Counts& expected);

}  // namespace hamgen::instructions
