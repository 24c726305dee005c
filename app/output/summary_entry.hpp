// A line of what a command says of its result: what it is about, and text beside it.
#pragma once

#include <string>
#include <string_view>

namespace hamgen::app {

constexpr std::size_t summary_width = 96;

// "  solver      text ...", wrapped under the text; "q = 0.5" stays in one line.
[[nodiscard]] std::string summary_entry(std::string_view label, const std::string& text);

}  // namespace hamgen::app
