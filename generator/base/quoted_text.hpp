// User text on its way out: names, comments, units, options, paths.  What is written into a file
// that a compiler, a browser, gnuplot or a terminal reads passes through one of these, so that it
// stays text there.
//
// Control characters (is_control) and bytes that are not UTF-8 become visible, <U+000D> or <0xFF>:
// a line must not end where the reader does not see it, nor be shown in another order than it is
// read.
#pragma once

#include <string>
#include <string_view>

namespace hamgen {

// Several lines for people: line ends and tabs stay.
[[nodiscard]] std::string visible_lines(std::string_view text);

// One line for people; tabs stay.
[[nodiscard]] std::string visible_text(std::string_view text);

// The end of a line that begins with // (C++) or # (CMake, CSV, gnuplot).  A backslash at its end,
// blanks after it or not, would let a compiler read on: it gets a full stop.
[[nodiscard]] std::string comment_text(std::string_view text);

// A string literal of C++ with these bytes, its quotes included.
[[nodiscard]] std::string cpp_string(std::string_view text);

// Content or an attribute's value of HTML, several lines.
[[nodiscard]] std::string html_text(std::string_view text);

// A title or label of gnuplot with its quotes: single ones, in which it looks for neither escapes
// nor commands.
[[nodiscard]] std::string gnuplot_text(std::string_view text);

// A file name of gnuplot with its quotes.  Its bytes count: one that gnuplot_text would change is
// written in octal.
[[nodiscard]] std::string gnuplot_path(std::string_view path);

}  // namespace hamgen
