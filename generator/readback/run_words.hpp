// The routines of a run, which keep what steps remember, in the words of the language: what an
// emitted file has to have there word by word.
#pragma once

#include <string>

#include "generator/program/program.hpp"

namespace hamgen {

struct RunLanguage {
  bool c = false;  // C, in whose words N:: begins a name of the header, hamgen:: that of a block
  int n = 0;       // what C++ calls n; else 0
};

// The whole routine, from its type to its last brace.
[[nodiscard]] std::string words_of(const Routine& routine, const RunLanguage& language);

}  // namespace hamgen
