// Enough of UTF-8 to count columns and to name an illegal byte.
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

// The text made safe to print on a terminal: tabs become one space, other control characters and
// illegal bytes '?'.  The number of code points, illegal bytes counting one each, is kept.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace hamgen
