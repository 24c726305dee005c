// A stress map as a picture: a coloured box a cell, the linear bound over it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/stress.hpp"

namespace hamgen::app {
namespace {

struct Shade {
  std::string_view colour;
  std::string_view label;
};

// Energy errors relative to their scale, each shade for three powers of ten; light is good, so that
// the failures stand out in print too.
constexpr std::array<Shade, 6> kShades = {{{"#E8F4EA", "energy error < 1e-12"},
                                           {"#BFE3C6", "< 1e-9"},
                                           {"#8CCB9B", "< 1e-6"},
                                           {"#56B4E9", "< 1e-3"},
                                           {"#0072B2", "< 1"},
                                           {"#1B3F66", "< 10 scales"}}};
constexpr std::array<Shade, kStressOutcomes> kFailures = {{{"", ""},
                                                           {"#E69F00", "jumped"},
                                                           {"#F0E442", "escaped"},
                                                           {"#D55E00", "not converged"},
                                                           {"#CC79A7", "left the domain"},
                                                           {"#7F0000", "overflow"},
                                                           {"#AAAAAA", "out of time"}}};

// 0 to 5 for a cell that is done, 6 and more for its failure.
std::size_t shade_of(const StressCell& cell) {
  if (cell.outcome != StressOutcome::done)
    return kShades.size() + static_cast<std::size_t>(cell.outcome) - 1;
  const double error = cell.energy_error / std::max(cell.energy_scale, 1e-300);
  for (std::size_t i = 0; i + 1 < kShades.size(); ++i) {
    if (error < std::pow(10.0, -12.0 + 3.0 * static_cast<double>(i))) return i;
  }
  return kShades.size() - 1;
}

const Shade& shade(std::size_t i) {
  return i < kShades.size() ? kShades[i] : kFailures[i - kShades.size() + 1];
}

// The borders of the boxes around an axis' values: halfway between neighbours.
std::vector<double> borders(const StressAxis& axis) {
  const auto map = [&](double x) { return axis.logarithmic ? std::log10(x) : x; };
  const auto back = [&](double x) { return axis.logarithmic ? std::pow(10.0, x) : x; };
  const std::vector<double>& v = axis.values;
  const double edge = v.size() > 1 ? map(v[1]) - map(v[0]) : 1.0;
  std::vector<double> result = {back(map(v.front()) - 0.5 * edge)};
  for (std::size_t i = 1; i < v.size(); ++i)
    result.push_back(back(0.5 * (map(v[i - 1]) + map(v[i]))));
  const double last = v.size() > 1 ? map(v.back()) - map(v[v.size() - 2]) : 1.0;
  result.push_back(back(map(v.back()) + 0.5 * last));
  return result;
}

// Single quotes: gnuplot then looks for neither escapes nor commands.
std::string in_quotes(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += c;
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + "'";
}

std::string range_text(char name, const StressAxis& axis, const std::vector<double>& border) {
  return fmt::format("{0} logscale {1}\nset format {1} '{2}'\nset {1}range [{3:.9g}:{4:.9g}]\n",
                     axis.logarithmic ? "set" : "unset", name,
                     axis.logarithmic ? "10^{%L}" : "%.4g", border.front(), border.back());
}

}  // namespace

std::string stress_script(const StressMap& map, const std::string& output) {
  const bool png = output.ends_with(".png");
  const StressAxis single{.label = "", .logarithmic = false, .values = {0.0}};
  const StressAxis& down = map.axes.size() > 1 ? map.axes[1] : single;
  const std::vector<double> x = borders(map.axes[0]);
  const std::vector<double> y = borders(down);
  std::string text = fmt::format(
      "# Drawn by: gnuplot THIS_FILE\nset terminal {}\nset output {}\n"
      "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n"
      "set key outside right top Left reverse noenhanced samplen 1.5\nset tics out nomirror\n"
      "set border 3\n",
      png ? "pngcairo size 1440,840 font 'Sans,11' fontscale 1.7 background rgb 'white'"
          : "svg size 720,420 dynamic enhanced font 'Helvetica, Arial, sans-serif,12' background "
            "rgb 'white'",
      in_quotes(output),
      in_quotes(fmt::format("{}{}: {}", map.model, map.scene.empty() ? "" : ", " + map.scene,
                            map.method)),
      in_quotes(map.axes[0].label), in_quotes(down.label));
  text += range_text('x', map.axes[0], x) + range_text('y', down, y);
  if (map.axes.size() == 1) text += "unset ytics\n";
  std::string plots;
  for (std::size_t i = 0; i < kShades.size() + kFailures.size() - 1; ++i) {
    std::string data;
    for (std::size_t cell = 0; cell < map.cells.size(); ++cell) {
      if (shade_of(map.cells[cell]) != i) continue;
      const std::size_t column = cell % map.columns();
      const std::size_t row = cell / map.columns();
      data += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", map.axes[0].values[column],
                          down.values[row], x[column], x[column + 1], y[row], y[row + 1]);
    }
    if (data.empty()) continue;
    text += fmt::format("$cells_{} << EOD\n{}EOD\n", i, data);
    plots += fmt::format(
        "{}$cells_{} using 1:2:3:4:5:6 with boxxyerror fs solid 1 noborder lc rgb "
        "'{}' title '{}'",
        plots.empty() ? "" : ", \\\n     ", i, shade(i).colour, shade(i).label);
  }
  if (!map.linear_bound.empty()) {
    text += "$bound << EOD\n";
    for (const auto& point : map.linear_bound)
      text += fmt::format("{:.9g} {:.9g}\n", point[0], point[1]);
    text += "EOD\n";
    plots +=
        ", \\\n     $bound using 1:2 with points pt 7 ps 0.35 lc rgb 'black' title 'linear bound'";
  }
  return text + "plot " + plots + "\nunset output\n";
}

}  // namespace hamgen::app
