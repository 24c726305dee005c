// Runs the hamgen executable as a user would, without a shell in between or with one.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hamgen::app_test {

struct Result {
  int status = -1;  // exit status, or 128 + signal
  std::string out;
  std::string err;
};

// Environment entries such as "CXX=clang++" are added to this process's own.
[[nodiscard]] Result hamgen(const std::vector<std::string>& arguments,
                            const std::vector<std::string>& environment = {},
                            const std::string& working_directory = ".");

// A command line for the shell, which finds this hamgen first.
[[nodiscard]] Result shell(const std::string& command, const std::string& working_directory = ".");
// The exit status of a program, a path and its words, or 128 + signal; what it says of mistakes
// goes into the file.
[[nodiscard]] int status_of(const std::vector<std::string>& words, const std::string& err);

// That of the command if it is killed so long after its beginning: 128 + SIGKILL where that met it.
[[nodiscard]] int status_if_killed(const std::vector<std::string>& arguments,
                                   std::chrono::microseconds after);

// A directory that is removed at the end of the test.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] std::string path(std::string_view name) const;
  // Writes a file and returns its path.
  std::string write(std::string_view name, std::string_view text) const;
  // Names in the directory, sorted.
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  std::filesystem::path directory_;
};

[[nodiscard]] std::string read(const std::string& path);
[[nodiscard]] std::vector<std::string> lines(const std::string& text);
[[nodiscard]] bool contains(const std::string& text, std::string_view part);

}  // namespace hamgen::app_test
