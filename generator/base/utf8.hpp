// Enough of UTF-8 to count columns, to name an illegal byte and to know a control character.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace hamgen {

struct CodePoint {
  char32_t value = 0;
  std::size_t length = 1;  // in bytes
};

// The code point at the offset; empty where the bytes are not UTF-8 (overlong forms and
// surrogates are not).
[[nodiscard]] std::optional<CodePoint> code_point_at(std::string_view text, std::size_t offset);

// Characters that end a line, move the cursor or turn the order in which text is shown, so that a
// reader sees something else than a compiler: Unicode's category Cc (tab and line ends included),
// the separators of lines and paragraphs, and the property Bidi_Control.
[[nodiscard]] bool is_control(char32_t character);

// The text behind a byte order mark, if it begins with one.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

// A line of a source as a terminal can show it, code point by code point: tabs become one space,
// other control characters and illegal bytes '?'.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace hamgen
