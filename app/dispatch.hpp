// Picks the subcommand, runs it, and turns what it throws into an exit status.
#pragma once

#include <string>
#include <vector>

namespace hamgen::app {

// `words` are the command's arguments, its own name left out.
[[nodiscard]] int dispatch(const std::vector<std::string>& words);

}  // namespace hamgen::app
