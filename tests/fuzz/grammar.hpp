// Texts by the grammar of docs/language.md, most of them models, each with its seed.
#pragma once

#include <cstdint>
#include <string>

namespace hamgen::fuzz {

// Every statement and every operator appears; names are right more often than not, and now and then
// a word is left out, doubled or replaced.  The same text for the same seed everywhere.
[[nodiscard]] std::string random_text(std::uint64_t seed);

}  // namespace hamgen::fuzz
