// Picks the subcommand, runs it, and turns what it throws into an exit status.
#pragma once

#include <string>
#include <vector>

namespace hamgen::app {

class Crew;

// `words` are the command's arguments, its own name left out; `crew` is who works on an ensemble.
[[nodiscard]] int dispatch(const std::vector<std::string>& words, Crew& crew);

}  // namespace hamgen::app
