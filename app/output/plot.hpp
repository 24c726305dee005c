// Pictures of lines and points, as scripts for gnuplot.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hamgen::app {

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
  double low = 0.0;  // of a band, whose upper end is y
};

enum class PlotStyle { lines, thin_lines, points, dots, lines_and_points, band, mark };

struct PlotSeries {
  std::string label;  // in the legend; may be empty
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
  std::optional<double> floor;  // of a logarithmic y: what is below is rounding
};

struct Plot {
  std::vector<PlotPanel> panels;
  int width = 560;  // of a panel [pixels]
  int height = 420;
  bool stacked = false;  // panels one below the other, not side by side
};

// Whether one unit on both axes would leave no mere strip.
[[nodiscard]] bool suits_one_unit(const PlotPanel& panel);

// Of the names below a panel in a picture of this width; 0 without names.
[[nodiscard]] int legend_rows(const PlotPanel& panel, int width);

// The whole script, data and output included; the legend is beneath.  The path's ending chooses svg
// or png.  Points that a logarithmic axis or a number cannot hold are left out.
[[nodiscard]] std::string gnuplot_script(const Plot& plot, const std::string& output);

}  // namespace hamgen::app
