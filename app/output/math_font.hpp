// The font of formulas.
#pragma once

#include <string>

namespace hamgen::app {

// A rule of CSS that holds the font `Formula`, with the characters that formulas use; empty where
// it is not installed: formulas then have the browser's font for mathematics.
[[nodiscard]] std::string math_font_style();

// For data inside of a page.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace hamgen::app
