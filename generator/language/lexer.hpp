// Source text to words.
#pragma once

#include "generator/language/token.hpp"

namespace hamgen {

// A line ends a statement unless a parenthesis or bracket is open; a line that begins with a
// keyword ends it even then, so that one forgotten parenthesis spoils one statement only.
[[nodiscard]] Tokens read_tokens(const SourceText& source);

}  // namespace hamgen
