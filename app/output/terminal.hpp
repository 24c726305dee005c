// Standard output and standard error.  What is said may quote a command line, a path or the output
// of a tool: control characters are made visible (generator/base/quoted_text.hpp).
#pragma once

#include <string_view>

namespace hamgen::app {

// Writes to standard output; throws ToolError if that fails (a full disk, say).
void print(std::string_view text);
// The same for numbers, which are written as they are; the text may wait for the next print().
void print_buffered(std::string_view text);
// Writes to standard error, whatever happens.
void print_error(std::string_view text);

}  // namespace hamgen::app
