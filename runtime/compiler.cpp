#include "runtime/compiler.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "runtime/process.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

namespace fs = std::filesystem;

bool is_executable(const fs::path& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode) &&
         ::access(path.c_str(), X_OK) == 0;
}

// The absolute path of a program named by a path or found in PATH.
std::optional<fs::path> find_program(const std::string& name) {
  if (name.empty()) return {};
  if (name.find('/') != std::string::npos) {
    std::error_code failed;
    const fs::path path = fs::absolute(name, failed);
    if (!failed && is_executable(path)) return path;
    return {};
  }
  const char* const search = std::getenv("PATH");
  std::istringstream folders(search != nullptr ? search : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    // An empty entry means the current directory to a shell; a compiler is not taken from there.
    if (folder.empty()) continue;
    std::error_code failed;
    const fs::path path = fs::absolute(fs::path(folder) / name, failed);
    if (!failed && is_executable(path)) return path;
  }
  return {};
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// Note [compiler identity]
// Running `g++ --version` would cost a tenth of the time a cached start may take.  The path, the
// path behind its links, the size and the time of last change tell one compiler from another and
// change with every upgrade of its package.  All words that name a program count, so that behind
// `ccache g++` the compiler is seen too.  A wrapper script that starts to call another compiler
// without being edited is not noticed: `hamgen cache clear` is the way out.
std::string identity_of(const std::vector<std::string>& command) {
  std::string identity;
  for (const std::string& word : command) {
    identity += fmt::format("{}\n", word);
    if (word.starts_with('-')) continue;
    const std::optional<fs::path> path = find_program(word);
    struct stat info {};
    if (!path || ::stat(path->c_str(), &info) != 0) continue;
    std::error_code failed;
    identity += fmt::format("  {} {} {}.{:09}\n", fs::canonical(*path, failed).string(),
                            info.st_size, info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
  }
  return identity;
}

std::optional<Compiler> compiler_from(const std::string& choice, const std::string& chosen_by) {
  std::vector<std::string> command = is_executable(choice) && choice.find('/') != std::string::npos
                                         ? std::vector<std::string>{choice}
                                         : words_of(choice);
  if (command.empty()) return {};
  const std::optional<fs::path> program = find_program(command.front());
  if (!program) return {};
  command.front() = program->string();
  return Compiler{.command = command, .identity = identity_of(command), .chosen_by = chosen_by};
}

[[noreturn]] void throw_not_found(std::string_view name, std::string_view chosen_by) {
  throw ToolError(
      {.message = fmt::format(
           "the C++ compiler '{}' named by {} was not found, or is not an executable file\n"
           "help: name one with --compiler or CXX, such as CXX=g++; on Debian: apt install g++",
           name, chosen_by)});
}

}  // namespace

Compiler find_compiler(const std::optional<std::string>& explicit_choice) {
  std::string choice;
  std::string chosen_by;
  if (explicit_choice) {
    choice = *explicit_choice;
    chosen_by = "--compiler";
  } else if (const char* const variable = std::getenv("CXX");
             variable != nullptr && !words_of(variable).empty()) {
    choice = variable;
    chosen_by = "$CXX";
  }
  if (!chosen_by.empty()) {
    if (const std::optional<Compiler> found = compiler_from(choice, chosen_by)) return *found;
    const std::vector<std::string> words = words_of(choice);
    throw_not_found(words.empty() ? choice : words.front(), chosen_by);
  }
  for (const char* const name : {"g++", "clang++"}) {
    if (const std::optional<Compiler> found = compiler_from(name, "the default")) return *found;
  }
  throw ToolError(
      {.message =
           "no C++ compiler was found: neither g++ nor clang++ is in PATH\n"
           "help: on Debian: apt install g++; or name one with --compiler or CXX; `hamgen run "
           "--interpret` needs none"});
}

std::string compiler_version(const Compiler& compiler, const std::atomic<bool>* stop) {
  std::vector<std::string> command = compiler.command;
  command.push_back("--version");
  const ProcessResult result =
      run_process({.command = command, .time_limit = std::chrono::seconds(10), .stop = stop});
  return result.output.substr(0, result.output.find('\n'));
}

}  // namespace hamgen::runtime
