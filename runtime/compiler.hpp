// Which C++ compiler to use.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace hamgen::runtime {

// A program that compiles C++, with the arguments that belong to it.
struct Compiler {
  // The program's absolute path, then the arguments that came with it (`CXX='ccache g++ -m64'`).
  std::vector<std::string> command;
  // Differs when the compiler differs.  See Note [compiler identity].
  std::string identity;
  std::string chosen_by;  // "--compiler", "$CXX" or "the default"

  friend bool operator==(const Compiler&, const Compiler&) = default;
};

// The explicit choice, else $CXX if it is set and not blank, else g++, else clang++.
//
// A choice that is itself an executable is used whole, spaces and all; otherwise it is split at
// white space, the first word is the program and the rest are its first arguments.  No shell is
// involved: in `g++; rm x` the program is called `g++;`.  A choice that is not found is an error,
// never replaced by another compiler.  Throws ToolError.
[[nodiscard]] Compiler find_compiler(const std::optional<std::string>& explicit_choice = {});

// The words of "g++ --version"'s first line.  Costs a process (about 5 ms): for people only.  Does
// not wait for it any longer once `stop` is set, if given.
[[nodiscard]] std::string compiler_version(const Compiler& compiler,
                                           const std::atomic<bool>* stop = nullptr);

}  // namespace hamgen::runtime
