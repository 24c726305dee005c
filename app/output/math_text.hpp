// Sentences with formulas, as findings have them, for web pages.
#pragma once

#include <string>
#include <string_view>

namespace hamgen::app {

// A text in which formulas stand between grave accents: "`C^T M + M C = 0` for its form".  They are
// set as the page's other formulas are; a line may end before a sign of relation.
[[nodiscard]] std::string math_prose(std::string_view text);

}  // namespace hamgen::app
