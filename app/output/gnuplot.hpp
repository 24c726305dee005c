// Pictures are drawn by gnuplot, from scripts that hold their own data.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "app/studies/stop.hpp"

namespace hamgen::app {

// The line of a script that names its picture, in the folder where the script is run.
[[nodiscard]] std::string output_line(const std::string& output);

// The beginning of a script: the terminal that the path's ending chooses, with this size in pixels,
// the output and the style of borders.
[[nodiscard]] std::string script_head(const std::string& output, int width, int height);

// Runs gnuplot on the text of a script whose output is the picture, which appears whole or not at
// all.  Returns an empty text, or why there is no picture (gnuplot is missing or failed): no reason
// to give up what else was computed.  Throws ToolError where the picture cannot be written.
[[nodiscard]] std::string run_gnuplot(const std::string& script,
                                      const std::filesystem::path& picture, StopFlag stop);

// An SVG of gnuplot's with a style by which it is light on dark where its reader prefers that.
[[nodiscard]] std::string with_dark_form(const std::string& svg);

}  // namespace hamgen::app
