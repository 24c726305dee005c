// Lists as users write them on a command line: "1/2, f(a, b), [[1, 0], [0, 1]]".
#pragma once

#include <string_view>
#include <vector>

namespace hamgen {

[[nodiscard]] std::string_view without_blanks(std::string_view text);

// The pieces between the commas that stand outside all brackets, without blanks around them.
[[nodiscard]] std::vector<std::string_view> outermost_pieces(std::string_view text);

}  // namespace hamgen
