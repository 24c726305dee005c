// The contract of emitted steps: one program for many models and methods, compiled and run.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/contract/case.hpp"

namespace hamgen::contract {

// One translation unit that runs all cases and prints what read_defects reads.  `edit` may change
// the text of the emitted code that is measured, not of the quad code.
[[nodiscard]] std::string program(const std::vector<Case>& cases,
                                  const std::function<std::string(std::string)>& edit = {});
[[nodiscard]] std::vector<Defects> read_defects(const std::string& output);

// Compiles and runs the program; throws std::runtime_error with the compiler's words.
[[nodiscard]] std::vector<Defects> measure(
    const std::vector<Case>& cases, const std::function<std::string(std::string)>& edit = {});

}  // namespace hamgen::contract
