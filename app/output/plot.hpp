// Pictures: panels of lines, drawn by gnuplot from a script that holds its own data.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/studies/stop.hpp"

namespace hamgen::app {

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
};

enum class PlotStyle { lines, points, dots, lines_and_points };

struct PlotSeries {
  std::string label;  // written at the end of the line; may be empty
  std::vector<PlotPoint> points;
  PlotStyle style = PlotStyle::lines_and_points;
  int colour = -1;  // which of the colours; -1: by position
};

struct PlotPanel {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool logarithmic_x = false;
  bool logarithmic_y = false;
  bool square = false;  // the same unit on both axes
  std::vector<PlotSeries> series;
};

struct Plot {
  std::vector<PlotPanel> panels;  // side by side
  int width = 560;                // of a panel [pixels]
  int height = 420;
};

// The beginning of a script: the terminal that the path's ending chooses, with this size in pixels,
// the output and the style of borders.
[[nodiscard]] std::string script_head(const std::string& output, int width, int height);

// The whole script, data and output path included.  The path's ending chooses svg or png.  Points
// that a logarithmic axis or a number cannot hold are left out.
[[nodiscard]] std::string gnuplot_script(const Plot& plot, const std::string& output);

// Runs gnuplot on the text of a script whose output is the picture, which appears whole or not at
// all.  Returns an empty text, or why there is no picture (gnuplot is missing or failed): no reason
// to give up what else was computed.
[[nodiscard]] std::string run_gnuplot(const std::string& script,
                                      const std::filesystem::path& picture, StopFlag stop);

}  // namespace hamgen::app
