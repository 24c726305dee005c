// A font for mathematics with the glyphs of some characters only, to be put into a page.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hamgen::app {

struct FontError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Of an OpenType font with outlines in CFF and a table MATH, all of the file's bytes: the same font
// with the outlines of these characters, and of the larger forms and parts that its table MATH has
// for them.  Glyphs keep their numbers; all others are empty, and tables that a formula does not
// need are left out.  Throws FontError for what is no such font.  Source: OpenType 1.9, Adobe
// technical note 5176 (CFF).
[[nodiscard]] std::string font_subset(std::string_view font, std::span<const char32_t> characters);

}  // namespace hamgen::app
