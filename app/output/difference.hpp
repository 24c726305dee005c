// How one text differs from another.
#pragma once

#include <string>
#include <string_view>

namespace hamgen::app {

// A unified diff of one hunk, from the first line that differs to the last, with three lines around
// it; cut after `max_lines`.  Empty for equal texts.
[[nodiscard]] std::string difference(std::string_view old_name, std::string_view old_text,
                                     std::string_view new_name, std::string_view new_text,
                                     std::size_t max_lines = 60);

}  // namespace hamgen::app
