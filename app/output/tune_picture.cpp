#include "app/output/tune_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/output/gnuplot.hpp"
#include "app/output/plain_number.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/csv_writer.hpp"

namespace hamgen::app {
namespace {

// Colours span at least this factor: a map with little to gain looks as flat as it is.
constexpr double kLeastRange = 10.0;

// About five ticks, at multiples of 1, 2 or 5 times a power of ten.
double tick_distance(const MapAxis& axis) {
  const double wish = (axis.high - axis.low) / 5;
  const double power = std::pow(10.0, std::floor(std::log10(wish)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= wish) return factor * power;
  }
  return 10 * power;
}

// Cells are drawn around their centres, those at the rim too.
std::string map_range(const char* name, const MapAxis& axis) {
  const double half = (axis.high - axis.low) / (axis.count - 1) / 2;
  return fmt::format("set {0}range [{1:.9g}:{2:.9g}]\nset {0}tics {3:.9g}\n", name, axis.low - half,
                     axis.high + half, tick_distance(axis));
}

// Powers of ten; where there would be fewer than three of them, five numbers of the range.
std::string colour_ticks(const std::vector<double>& drawn) {
  if (drawn.empty()) return "";
  const auto [low, highest] = std::ranges::minmax(drawn);
  const double high = std::max(highest, kLeastRange * low);
  if (high > 1e3 * low) return "set format cb '10^{%T}'\n";
  constexpr int ticks = 5;
  std::string text;
  for (int i = 0; i < ticks; ++i) {
    const double value = low * std::pow(high / low, i / (ticks - 1.0));
    text += fmt::format("{}'{:.2e}' {:.6g}", i == 0 ? "" : ", ", value, value);
    if (!(high > 1.001 * low)) break;
  }
  return fmt::format("set cbrange [{:.6g}:{:.6g}]\nset cbtics ({})\n", low, high, text);
}

// Lines of level at multiples of the least value: few per cent where the range is small, else
// powers of ten and their halves.
std::string contour_text(const std::vector<double>& drawn) {
  if (drawn.empty()) return "";
  const auto [low, high] = std::ranges::minmax(drawn);
  std::vector<double> factors = {1.05, 1.2, 1.5, 2.0, 5.0};
  if (high > kLeastRange * low) {
    factors.clear();
    for (double power = 1.0; power * low < high; power *= 10.0) {
      for (const double factor : {1.0, 3.0}) factors.push_back(factor * power);
    }
  }
  std::string levels;
  for (const double factor : factors) {
    if (factor > 1.0 && factor * low < high)
      levels += fmt::format("{}{:.6g}", levels.empty() ? "" : ", ", factor * low);
  }
  if (levels.empty()) return "";
  return fmt::format(
      "set contour base\nunset surface\nset cntrparam levels discrete {}\n"
      "set table $levels\nsplot $map using 1:2:3\nunset table\nunset contour\n",
      levels);
}

// Black on a white rim: seen on every colour.
std::string mark(const MapPoint& point, int shape, const std::string& title) {
  const std::string at = fmt::format("'+' using ({:.9g}):({:.9g}) every ::::0 with points pt {}",
                                     point.b, point.c, shape);
  return fmt::format(
      ", \\\n  {0} ps 2.6 lw 6 lc rgb 'white' notitle"
      ", \\\n  {0} ps 2.4 lw 2.5 lc rgb 'black' title {1}",
      at, gnuplot_text(title));
}

std::string what_stays_bounded(const EnergyMap& map) {
  std::string text;
  if (map.lowest_b) text += fmt::format("b > {}", terminal_number(*map.lowest_b, 3));
  if (map.highest_c)
    text += fmt::format("{}c < {}", text.empty() ? "" : ", ", terminal_number(*map.highest_c, 3));
  return text.empty() ? text : "\\n(the linear part is sure to stay bounded for " + text + ")";
}

// Beyond the linear bound a small spread means little.
bool is_bounded(const EnergyMap& map, const MapPoint& at) {
  return at.b > map.lowest_b.value_or(-HUGE_VAL) && at.c < map.highest_c.value_or(HUGE_VAL);
}

}  // namespace

bool is_drawn(double spread) { return std::isfinite(spread) && spread > 0.0; }

std::string map_csv(const EnergyMap& map, const std::string& header) {
  std::string text = header + "b,c,energy_spread\n";
  std::size_t i = 0;
  for (int row = 0; row < map.c.count; ++row) {
    for (int column = 0; column < map.b.count; ++column, ++i) {
      const std::string spread =
          std::isfinite(map.spread[i]) ? runtime::number_text(map.spread[i]) : "";
      text += fmt::format("{},{},{}\n", runtime::number_text(map.b.at(column)),
                          runtime::number_text(map.c.at(row)), spread);
    }
  }
  return text;
}

std::string map_script(EnergyMap map, double scale, const std::string& title,
                       const std::string& output) {
  const double unit = scale > 0.0 ? scale : 1.0;
  for (double& spread : map.spread) spread /= unit;
  const bool svg = output.ends_with(".svg");
  std::string text = fmt::format(
      "# Drawn by: gnuplot THIS_FILE\n"
      "set terminal {} enhanced font 'Sans,11' background rgb 'white'\n"
      "{}"
      "set encoding utf8\n"
      "set title {} noenhanced\n"
      "set xlabel \"b, β = b h{}\"\nset ylabel 'c, γ = c h'\n"
      "set cblabel 'max H − min H{}' offset {},0\nset logscale cb\n"
      "set palette defined (0 '#440154', 1 '#3B528B', 2 '#21918C', 3 '#5EC962', 4 '#FDE725')\n"
      "set tics out nomirror\n"
      // Room for the numbers and the title of the colours, and for the key below the axis' label.
      "set rmargin at screen 0.79\nset lmargin at screen 0.12\n"
      "set tmargin at screen 0.92\nset bmargin at screen 0.25\n"
      "set key at screen 0.455,0.11 center top horizontal maxcols 2 noenhanced\n",
      svg ? "svg size 700,580" : "pngcairo size 1400,1160 fontscale 1.7", output_line(output),
      gnuplot_text(title), what_stays_bounded(map),
      scale > 0.0 ? ", relative to " + terminal_number(scale, 3) : "", svg ? 2 : 1);
  text += map_range("x", map.b) + map_range("y", map.c);
  std::vector<double> drawn;
  std::ranges::copy_if(map.spread, std::back_inserter(drawn), is_drawn);
  text += colour_ticks(drawn);
  const bool has_failures = drawn.size() < map.spread.size();
  if (has_failures)
    text +=
        "set object 1 rectangle from graph 0, graph 0 to graph 1, graph 1 behind fc rgb "
        "'#BBBBBB'\n";
  const bool b_ends = map.lowest_b && *map.lowest_b > map.b.low && *map.lowest_b < map.b.high;
  const bool c_ends = map.highest_c && *map.highest_c > map.c.low && *map.highest_c < map.c.high;
  constexpr const char* line = "nohead front dt 2 lw 3 lc rgb 'red'\n";
  if (b_ends)
    text += fmt::format("set arrow from first {0:.9g}, graph 0 to first {0:.9g}, graph 1 {1}",
                        *map.lowest_b, line);
  if (c_ends)
    text += fmt::format("set arrow from graph 0, first {0:.9g} to graph 1, first {0:.9g} {1}",
                        *map.highest_c, line);
  text += "$map << EOD\n";
  MapPoint best;
  double least = HUGE_VAL;
  std::size_t i = 0;
  for (int row = 0; row < map.c.count; ++row) {
    for (int column = 0; column < map.b.count; ++column, ++i) {
      const MapPoint at{map.b.at(column), map.c.at(row)};
      const bool shown = is_drawn(map.spread[i]);
      if (shown && is_bounded(map, at) && map.spread[i] < least) {
        least = map.spread[i];
        best = at;
      }
      text += fmt::format("{:.9g} {:.9g} {}\n", at.b, at.c,
                          shown ? fmt::format("{:.9g}", map.spread[i]) : "NaN");
    }
    text += "\n";
  }
  const std::string contours = contour_text(drawn);
  text += "EOD\n" + contours + "plot $map using 1:2:3 with image notitle";
  if (!contours.empty()) text += ", \\\n  $levels with lines lw 1.2 lc rgb '#FFFFFF' notitle";
  text += mark({}, 4, "midpoint rule");
  text += mark(map.fitted, 2, fmt::format("fitted: {:.5g}, {:.5g}", map.fitted.b, map.fitted.c));
  if (std::isfinite(least)) text += mark(best, 6, fmt::format("best cell: {:.3g}", least));
  if (b_ends || c_ends)
    text += ", \\\n  keyentry with lines dt 2 lw 3 lc rgb 'red' title 'linear bound'";
  if (has_failures) text += ", \\\n  keyentry with boxes fs solid fc rgb '#BBBBBB' title 'failed'";
  return text + "\nunset output\n";
}

}  // namespace hamgen::app
