// How a name is shown in a formula.
#pragma once

#include <string>
#include <string_view>

namespace hamgen::app {

struct SymbolMarkup {
  std::string letter;     // MathML; a Greek letter, a letter or a word
  std::string subscript;  // the same; may be empty
};

// "omega" is a Greek letter.  What follows a letter is its subscript where it is a number ("q1"),
// behind an underscore ("v_max"), one small letter ("px", "rc"), or a Greek letter of a momentum
// ("ptheta").  Other words are upright, as the names of functions are.
[[nodiscard]] SymbolMarkup symbol_markup(std::string_view name);

// The same on one line of plain text, as pictures have it: "θ₁", "px", "q[3]".
[[nodiscard]] std::string plain_symbol(std::string_view name);

// A line of text with the names of Greek letters as letters: "α = 1/2"; "β = β" is "β varied".
[[nodiscard]] std::string greek_text(std::string_view text);

}  // namespace hamgen::app
