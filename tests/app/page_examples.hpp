// What a page shows of commands, run and compared.
#pragma once

#include <cstddef>
#include <string>

namespace hamgen::app_test {

// Runs every "$ command" of the page's blocks marked `console` in the directory, with the shell and
// with this build's hamgen, and compares what it prints with what the page shows: numbers to a part
// in a thousand, "..." for any number of lines.  The page has at least so many of them.
void expect_page_is_true(const std::string& page, const std::string& directory, std::size_t least);

}  // namespace hamgen::app_test
