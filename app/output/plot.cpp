#include "app/output/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/output/gnuplot.hpp"
#include "app/output/plain_number.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

// Okabe and Ito's colours, told apart by colour-blind readers too; in grey print the dashes and
// markers do it.  M. Okabe, K. Ito: Color universal design (2008).
constexpr std::array<std::string_view, 8> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                      "#000000", "#E69F00", "#56B4E9", "#7F6000"};
constexpr std::array<std::string_view, 5> kDashes = {"1", "(8,3)", "(2.5,2.5)", "(10,3,2,3)",
                                                     "(16,4)"};
constexpr std::array<int, 8> kMarkers = {7, 5, 9, 13, 6, 4, 8, 12};

bool drawable(const PlotPanel& panel, const PlotPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) &&
         (!panel.logarithmic_x || point.x > 0.0) && (!panel.logarithmic_y || point.y > 0.0);
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Range padded(Range range, bool logarithmic) {
  if (!(range.low <= range.high)) return {logarithmic ? 0.1 : 0.0, 1.0};
  if (logarithmic) return {range.low / 1.6, range.high * 1.6};
  const double room = range.high > range.low
                          ? 0.04 * (range.high - range.low)
                          : (range.high != 0.0 ? 0.1 * std::fabs(range.high) : 1.0);
  return {range.low - room, range.high + room};
}

std::size_t colour_of(const PlotPanel& panel, std::size_t i) {
  const int chosen = panel.series[i].colour;
  return (chosen >= 0 ? static_cast<std::size_t>(chosen) : i) % kColours.size();
}

std::string style_text(const PlotPanel& panel, std::size_t i) {
  const std::size_t colour = colour_of(panel, i);
  const bool points = panel.series[i].style == PlotStyle::points;
  const bool lines = panel.series[i].style == PlotStyle::lines;
  const bool thin = panel.series[i].style == PlotStyle::thin_lines;
  const std::string line =
      fmt::format("lc rgb '{}' lw {} dt {}", kColours[colour], thin ? 1.0 : 1.6,
                  kDashes[lines || thin ? 0 : i % kDashes.size()]);
  switch (panel.series[i].style) {
    case PlotStyle::lines:
    case PlotStyle::thin_lines:
      return "with lines " + line;
    case PlotStyle::mark:
      return fmt::format("with points lc rgb '{}' pt 3 ps 1.6 lw 2", kColours[colour]);
    case PlotStyle::band:
      return fmt::format("with filledcurves fc rgb '{}' fs solid 0.3 noborder", kColours[colour]);
    case PlotStyle::dots:  // the same for all series: there are many
      return fmt::format("with points lc rgb '{}' pt 7 ps 0.15", kColours[colour]);
    case PlotStyle::points:
    case PlotStyle::lines_and_points:
      break;
  }
  return fmt::format("with {} {} pt {} ps {}", points ? "points" : "linespoints",
                     points ? fmt::format("lc rgb '{}'", kColours[colour]) : line,
                     kMarkers[i % kMarkers.size()], points ? 0.25 : 0.7);
}

std::string data_block(const PlotPanel& panel, std::size_t number) {
  std::string text;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const bool is_band = panel.series[i].style == PlotStyle::band;
    text += fmt::format("$data_{}_{} << EOD\n", number, i);
    for (const PlotPoint& point : panel.series[i].points) {
      if (!drawable(panel, point)) continue;
      text += fmt::format("{:.9g} {:.9g}", point.x, point.y);
      text += is_band ? fmt::format(" {:.9g}\n", point.low) : "\n";
    }
    text += "EOD\n";
  }
  return text;
}

bool has_points(const PlotPanel& panel, std::size_t i) {
  return std::ranges::any_of(panel.series[i].points,
                             [&panel](const auto& point) { return drawable(panel, point); });
}

struct PanelRanges {
  Range x, y;
};

PanelRanges ranges_of(const PlotPanel& panel) {
  PanelRanges ranges;
  for (const PlotSeries& series : panel.series) {
    for (const PlotPoint& point : series.points) {
      if (!drawable(panel, point)) continue;
      const double low = series.style == PlotStyle::band ? point.low : point.y;
      ranges.x = {std::min(ranges.x.low, point.x), std::max(ranges.x.high, point.x)};
      ranges.y = {std::min(ranges.y.low, low), std::max(ranges.y.high, point.y)};
    }
  }
  return ranges;
}

// A multiple of 1, 2 or 5 times a power of ten, `count` times in the range at most.
double round_distance(const Range& range, double count) {
  const double wish = (range.high - range.low) / count;
  const double power = std::pow(10.0, std::floor(std::log10(wish)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= wish) return factor * power;
  }
  return 10.0 * power;
}

// Where x and y have the same unit and one of them is much the shorter, gnuplot puts as many
// numbers on it as on the longer: one a 45 pixels at most, across, and one a 30 up.
std::string square_tics(const Range& x, const Range& y, int width, int height) {
  const double across = 0.8 * width;
  const double up = 0.78 * height;
  const double pixels = std::min(across / (x.high - x.low), up / (y.high - y.low));
  const auto tics = [pixels](char name, const Range& range, double least) {
    const double count = std::max(1.0, pixels * (range.high - range.low) / least);
    return fmt::format("set {}tics {:.9g}\n", name, round_distance(range, std::min(count, 8.0)));
  };
  return tics('x', x, 45.0) + tics('y', y, 30.0);
}

// Gnuplot puts up to ten numbers on an axis, however short it is: one needs 40 pixels.
std::string narrow_tics(const Range& x, bool logarithmic, int width) {
  const double fit = 0.8 * width / 40.0;
  if (logarithmic || fit >= 8.0) return "";
  return fmt::format("set xtics {:.9g}\n", round_distance(x, fit));
}

// The power of ten that the numbers on a linear axis leave to its label; 0: none.
int common_power(const Range& range, bool logarithmic) {
  const double largest = std::max(std::fabs(range.low), std::fabs(range.high));
  if (logarithmic || !(largest > 0.0) || (largest >= 1e-2 && largest < 1e5)) return 0;
  return static_cast<int>(std::floor(std::log10(largest)));
}

struct PlotAxis {
  char name = 'x';
  std::string label;
  bool logarithmic = false;
  Range range;
  int power = 0;  // of ten, that its numbers leave to the label

  // A value of the data as it is drawn: "1" or "($1/1e-6)".
  [[nodiscard]] std::string column(int number) const {
    return power == 0 ? std::to_string(number) : fmt::format("(${}/1e{})", number, power);
  }
  [[nodiscard]] Range drawn() const {
    const double unit = std::pow(10.0, power);
    return {range.low / unit, range.high / unit};
  }
};

std::string axis_text(const PlotAxis& axis) {
  const double decades = axis.logarithmic ? std::log10(axis.range.high / axis.range.low) : 0.0;
  const std::string label =
      axis.power == 0 ? axis.label : fmt::format("{}  [{}]", axis.label, power_of_ten(axis.power));
  return fmt::format(
      "set {0}label {1} noenhanced offset 0,{7}\n{2} logscale {0}\nset format {0} '{3}'\nset "
      "{0}tics {4}\n"
      "set {0}range [{5:.9g}:{6:.9g}]\n",
      axis.name, gnuplot_text(label), axis.logarithmic ? "set" : "unset",
      axis.logarithmic ? "10^{%L}" : "%.6g", decades > 8.0 ? "100" : "autofreq", axis.drawn().low,
      axis.drawn().high, axis.name == 'x' ? 0.4 : 0.0);
}

// A little less high than the letters at the axes, which script_head sets.
int small_font(bool png) { return png ? 9 : 12; }

// What is below is shaded, where the data come near to it.
std::string floor_text(const PlotPanel& panel, const Range& y, int font) {
  if (!panel.floor || !(*panel.floor > y.low && *panel.floor < y.high)) return "";
  return fmt::format(
      "set object rectangle from graph 0, graph 0 to graph 1, first {0:.9g} behind fc rgb "
      "'#DDDDDD' fs solid 0.55 noborder\n"
      "set label 'rounding' at graph 0.015, first {0:.9g} left offset 0,-0.75 font ',{1}' "
      "textcolor "
      "rgb "
      "'#555555'\n",
      *panel.floor, font);
}

std::size_t longest_label(const PlotPanel& panel) {
  std::size_t longest = 0;
  for (const PlotSeries& series : panel.series) longest = std::max(longest, series.label.size());
  return longest;
}

// Names side by side.
int legend_columns(const PlotPanel& panel, int width) {
  constexpr int letter = 7;  // units of the picture's width
  constexpr int sample = 45;
  return std::max(1, width / (letter * static_cast<int>(longest_label(panel)) + sample));
}

// Names beside short pieces of line or markers, in rows below the plot, as many in one as fit.
std::string legend_text(const PlotPanel& panel, int picture_width, bool png) {
  const int length = static_cast<int>(longest_label(panel));
  if (length == 0) return "unset key\n";
  // In SVG gnuplot takes letters for wider than they are, the more the longer a name is.
  const int width = png || length < 8 ? 2 : length < 15 ? -length / 5 : -length / 3;
  return fmt::format(
      "set key below center horizontal maxcols {} Left reverse noenhanced samplen 1.8 width {} "
      "height 0.6 font ',{}'\n",
      legend_columns(panel, picture_width), width, small_font(png));
}

std::string panel_text(const PlotPanel& panel, std::size_t number, int width, int height,
                       bool png) {
  PlotAxis x{.name = 'x', .label = panel.x_label, .logarithmic = panel.logarithmic_x, .range = {}};
  PlotAxis y{.name = 'y', .label = panel.y_label, .logarithmic = panel.logarithmic_y, .range = {}};
  const PanelRanges ranges = ranges_of(panel);
  y.range = ranges.y;
  x.range = padded(ranges.x, panel.logarithmic_x);
  constexpr double near = 100.0;  // the data come to the floor
  constexpr double room = 30.0;   // below it
  if (panel.floor && y.range.low < near * *panel.floor)
    y.range.low = std::min(y.range.low, *panel.floor / room);
  y.range = padded(y.range, panel.logarithmic_y);
  x.power = common_power(x.range, x.logarithmic);
  y.power = common_power(y.range, y.logarithmic);
  if (panel.square) x.power = y.power = std::max(x.power, y.power);
  std::string text =
      fmt::format("\nset title {} noenhanced\nunset label\nunset object\nset xtics autofreq\n",
                  gnuplot_text(panel.title));
  text += axis_text(x) + axis_text(y);
  text += panel.square ? "set size ratio -1\n" + square_tics(x.drawn(), y.drawn(), width, height)
                       : "set size noratio\n" + narrow_tics(x.drawn(), x.logarithmic, width);
  text += floor_text(panel, y.range, small_font(png)) + legend_text(panel, width, png);
  std::string plots;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    if (!has_points(panel, i)) continue;
    const PlotSeries& series = panel.series[i];
    plots += fmt::format("{}$data_{}_{} using {}:{}{} {} {}", plots.empty() ? "" : ", \\\n     ",
                         number, i, x.column(1), y.column(2),
                         series.style == PlotStyle::band ? ":" + y.column(3) : "",
                         series.label.empty() ? "notitle" : "title " + gnuplot_text(series.label),
                         style_text(panel, i));
  }
  return text + (plots.empty() ? "plot NaN notitle\n" : "plot " + plots + "\n");
}

}  // namespace

bool suits_one_unit(const PlotPanel& panel) {
  constexpr double strip = 0.25;
  const PanelRanges ranges = ranges_of(panel);
  const double across = ranges.x.high - ranges.x.low;
  const double up = ranges.y.high - ranges.y.low;
  return std::min(across, up) > strip * std::max(across, up);
}

int legend_rows(const PlotPanel& panel, int width) {
  const auto names = std::ranges::count_if(
      panel.series, [](const PlotSeries& series) { return !series.label.empty(); });
  const int columns = legend_columns(panel, width);
  return (static_cast<int>(names) + columns - 1) / columns;
}

std::string gnuplot_script(const Plot& plot, const std::string& output) {
  const std::size_t count = plot.panels.size();
  const int across = plot.stacked ? 1 : static_cast<int>(count);
  const int down = plot.stacked ? static_cast<int>(count) : 1;
  std::string text = script_head(output, plot.width * across, plot.height * down);
  for (std::size_t i = 0; i < count; ++i) text += data_block(plot.panels[i], i);
  text += fmt::format("set multiplot layout {},{}\n", down, across);
  for (std::size_t i = 0; i < count; ++i)
    text += panel_text(plot.panels[i], i, plot.width, plot.height, output.ends_with(".png"));
  return text + "unset multiplot\nunset output\n";
}

}  // namespace hamgen::app
