// The program beside this one that has the libraries that take long to load: Note [libraries that
// take long to load] in CMakeLists.txt.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hamgen::app {

// Do the command's arguments ask for what needs Arb or HDF5?
[[nodiscard]] bool needs_whole_program(const std::vector<std::string>& words);

// Becomes the program of that name in this one's folder, with the same arguments.  Returns, with an
// exit status and after a message, only where it cannot be started.
[[nodiscard]] int hand_over_to(std::string_view name, char** arguments);

}  // namespace hamgen::app
