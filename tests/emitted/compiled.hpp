// Emitted code in the hands of a compiler.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "generator/pipeline.hpp"
#include "runtime/process.hpp"

namespace hamgen::emitted_test {

// What every emitted header promises to compile under.
[[nodiscard]] std::vector<std::string> strict_flags();

// The compilers there are, of g++ and clang++.
[[nodiscard]] std::vector<std::string> compilers();

// Compiles the text (as one translation unit, by default without making code) and returns the
// messages; empty if it is clean.
[[nodiscard]] std::string messages(const std::string& compiler, const std::string& text,
                                   const std::vector<std::string>& flags = strict_flags(),
                                   const std::string& action = "-fsyntax-only");

// Compiles and runs a program with g++ -O0 -std=gnu++17, and these flags, of which the last -O
// counts, and returns its output.
[[nodiscard]] std::string run_program(const std::string& text,
                                      const std::vector<std::string>& flags = {});

// What a command prints; behind "failed:" where it fails.
[[nodiscard]] std::string output_of(const std::vector<std::string>& command);

[[nodiscard]] std::vector<std::filesystem::path> shipped_models();
// hamiltonians/MODEL.ham
[[nodiscard]] SourceText shipped(const std::string& model);
[[nodiscard]] std::string read(const std::filesystem::path& path);

// A header without its first line `#pragma once`, so that several fit one translation unit.
[[nodiscard]] std::string without_pragma(std::string header);

[[nodiscard]] int count(std::string_view text, std::string_view part);

}  // namespace hamgen::emitted_test
