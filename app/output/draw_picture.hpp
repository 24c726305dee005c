// A picture's two files, as commands leave them.
#pragma once

#include <filesystem>
#include <string>

#include "app/studies/stop.hpp"

namespace hamgen::app {

struct PictureFiles {
  std::filesystem::path picture;  // .svg or .png
  std::filesystem::path script;   // .gp
  std::string text;               // of the script, which draws the picture
};

// Writes the script, draws the picture and, unless quiet, says where they are.  Without gnuplot it
// says how to draw it: no reason to give up what else was computed.  False if there is no picture.
// Throws ToolError where a file cannot be written.
bool draw_picture(const PictureFiles& files, bool quiet, StopFlag stop);

}  // namespace hamgen::app
