// The table CFF of a font: its outlines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hamgen::app {

// The table with the outlines of these glyphs only, the others empty; names of glyphs are dropped.
// Throws FontError.
[[nodiscard]] std::string kept_outlines(std::string_view table, const std::vector<bool>& kept);

}  // namespace hamgen::app
