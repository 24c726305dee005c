// Texts with a few bytes, spans or words changed.
#pragma once

#include <string>
#include <vector>

#include "tests/fuzz/random.hpp"

namespace hamgen::fuzz {

// One to four changes of one of the texts: a byte, a span left out or put elsewhere, a word put in
// between, or the end of another text for its own.  The same mutant for the same state everywhere.
// None of the texts is empty; there is one at least, and one word.
[[nodiscard]] std::string mutant(const std::vector<std::string>& texts,
                                 const std::vector<std::string>& words, Random& random);

}  // namespace hamgen::fuzz
