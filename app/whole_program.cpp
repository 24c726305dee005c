#include "app/whole_program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "app/command_line.hpp"
#include "app/output/terminal.hpp"

namespace hamgen::app {

bool needs_whole_program(const std::vector<std::string>& words) {
  if (words.empty()) return false;
  if (words[0] == "certify") return true;
  const bool is_ensemble = words[0] == "ensemble";
  return std::ranges::any_of(words, [&](const std::string& word) {
    return word.starts_with("--certify") ||
           (is_ensemble && (word.ends_with(".h5") || word.ends_with(".hdf5")));
  });
}

int hand_over_to(std::string_view name, char** arguments) {
  std::error_code failure;
  std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failure);
  program.replace_filename(name);
  if (!failure) {
    execv(program.c_str(), arguments);
    failure = {errno, std::generic_category()};
  }
  print_error(
      fmt::format("hamgen: {} cannot be started: {}\nhelp: this part of hamgen needs it; "
                  "install or build hamgen again\n",
                  program.string(), failure.message()));
  return tool_failure;
}

}  // namespace hamgen::app
