// Text that is known word by word, but for its numbers.
#pragma once

#include <string>
#include <vector>

#include "generator/readback/text_scope.hpp"

namespace hamgen {

// C++ in which the word kConstant stands for the next of `constants`.
inline constexpr const char* kConstant = "CONSTANT_";
struct Pattern {
  std::string text;
  std::vector<Rational> constants = {};
};

// Takes the tokens of the pattern.  Throws TextDifference at the first that is another, or a
// constant of another value; `what` is what they belong to.
void expect_pattern(TokenCursor& cursor, const Pattern& pattern, const Precision& precision,
                    const std::string& what);

}  // namespace hamgen
