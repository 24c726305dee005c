// A stress map as a picture: a coloured box a cell, the linear bound over it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/output/gnuplot.hpp"
#include "app/output/math_symbol.hpp"
#include "app/output/stress_output.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

struct Shade {
  std::string_view colour;
  std::string_view label;
  int hatching = 0;  // gnuplot's number of the pattern, on white; 0: all of the box is filled
};

// Errors relative to their scale, each shade for three powers of ten; light is good, so that
// the failures stand out in print too.
constexpr std::array<Shade, 6> kShades = {{{"#E8F4EA", "error < 1e-12"},
                                           {"#BFE3C6", "< 1e-9"},
                                           {"#8CCB9B", "< 1e-6"},
                                           {"#56B4E9", "< 1e-3"},
                                           {"#0072B2", "< 1"},
                                           {"#1B3F66", "< 10 scales"}}};
constexpr std::array<Shade, runtime::kStatuses> kFailures = {{{"", ""},
                                                              {"#E69F00", "jumped"},
                                                              {"#F0E442", "escaped"},
                                                              {"#D55E00", "not converged"},
                                                              {"#CC79A7", "left the domain"},
                                                              {"#7F0000", "overflow"},
                                                              {"#DDDDDD", "stopped"},
                                                              {"#AAAAAA", "out of time"},
                                                              {"#333333", "undefined", 2}}};

// The state error of an orbit that is somewhere else on its torus: how large it is says nothing.
constexpr Shade kLost = {"#4B3B78", "phase lost (> 0.1)"};
constexpr double kLostError = 0.1;
// Hatched: neither the palest error nor a failure, in grey print too.
constexpr Shade kUnknown = {"#555555", "not known", 6};
constexpr std::size_t kAllShades = kShades.size() + kFailures.size() + 1;

// Places in the list of shades, failures, phase lost, unknown.
std::size_t shade_of_error(double error, double scale) {
  const double relative = error / std::max(scale, 1e-300);
  for (std::size_t i = 0; i + 1 < kShades.size(); ++i) {
    if (relative < std::pow(10.0, -12.0 + 3.0 * static_cast<double>(i))) return i;
  }
  return kShades.size() - 1;
}

std::size_t energy_shade(const StressCell& cell) {
  if (cell.outcome != runtime::Status::done)
    return kShades.size() + static_cast<std::size_t>(cell.outcome) - 1;
  return shade_of_error(cell.energy_error, cell.energy_scale);
}

std::size_t state_shade(const StressCell& cell) {
  if (cell.outcome != runtime::Status::done) return energy_shade(cell);
  if (!cell.state_error) return kAllShades - 1;
  if (*cell.state_error > kLostError * std::max(cell.state_scale, 1e-300)) return kAllShades - 2;
  return shade_of_error(*cell.state_error, cell.state_scale);
}

const Shade& shade(std::size_t i) {
  if (i < kShades.size()) return kShades[i];
  if (i + 2 == kAllShades) return kLost;
  return i + 1 < kAllShades ? kFailures[i - kShades.size() + 1] : kUnknown;
}

std::string filling(const Shade& shade) {
  return shade.hatching == 0 ? "fs solid 1" : fmt::format("fs pattern {}", shade.hatching);
}

using ShadeOf = std::size_t (*)(const StressCell&);

struct Panel {
  std::string name;  // of its data
  std::string title;
  ShadeOf shade_of = energy_shade;
};

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

std::string range_text(char name, const StressAxis& axis, const std::vector<double>& border) {
  return fmt::format("{0} logscale {1}\nset format {1} '{2}'\nset {1}range [{3:.9g}:{4:.9g}]\n",
                     axis.logarithmic ? "set" : "unset", name,
                     axis.logarithmic ? "10^{%L}" : "%.4g", border.front(), border.back());
}

std::string axis_label(const StressAxis& axis) {
  if (axis.label == "h") return "h, in steps of the scene";
  return axis.label == "scale" ? "scale of the initial state" : plain_symbol(axis.label);
}

// Which shades there are in any of the panels.
std::vector<bool> shades_of(const StressMap& map, const std::vector<Panel>& panels) {
  std::vector<bool> used(kAllShades, false);
  for (const Panel& panel : panels) {
    for (const StressCell& cell : map.cells) used[panel.shade_of(cell)] = true;
  }
  return used;
}

// A coloured box a cell and the linear bound; entries of the key for the shades of `key`.
std::string panel_text(const StressMap& map, const StressAxis& down, const Panel& panel,
                       const std::vector<bool>& key) {
  const std::vector<double> x = borders(map.axes[0]);
  const std::vector<double> y = borders(down);
  std::string text;
  std::vector<std::string> plots;
  for (std::size_t i = 0; i < kAllShades; ++i) {
    std::string data;
    for (std::size_t cell = 0; cell < map.cells.size(); ++cell) {
      if (panel.shade_of(map.cells[cell]) != i) continue;
      const std::size_t column = cell % map.columns();
      const std::size_t row = cell / map.columns();
      data += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", map.axes[0].values[column],
                          down.values[row], x[column], x[column + 1], y[row], y[row + 1]);
    }
    if (!data.empty()) {
      text += fmt::format("${}_{} << EOD\n{}EOD\n", panel.name, i, data);
      plots.push_back(
          fmt::format("${}_{} using 1:2:3:4:5:6 with boxxyerror {} noborder lc rgb '{}' notitle",
                      panel.name, i, filling(shade(i)), shade(i).colour));
    }
    if (i < key.size() && key[i])
      plots.push_back(fmt::format("keyentry with boxes {} {} fc rgb '{}' title '{}'",
                                  filling(shade(i)), shade(i).hatching == 0 ? "noborder" : "border",
                                  shade(i).colour, shade(i).label));
  }
  if (!map.linear_bound.empty())
    plots.emplace_back("$bound using 1:2 with points pt 7 ps 0.35 lc rgb 'black' notitle");
  if (!map.linear_bound.empty() && !key.empty())
    plots.emplace_back("keyentry with lines lw 3 lc rgb 'black' title 'linear bound'");
  return text + fmt::format("plot {}\n", fmt::join(plots, ", \\\n     "));
}

}  // namespace

std::string stress_script(const StressMap& map, const std::string& output) {
  const StressAxis single{.label = "", .logarithmic = false, .values = {0.0}};
  const StressAxis& down = map.axes.size() > 1 ? map.axes[1] : single;
  std::vector<Panel> panels = {{"energy", "largest energy error", energy_shade}};
  if (std::ranges::any_of(map.cells, [](const auto& cell) { return cell.state_error.has_value(); }))
    panels.push_back({"state", "state error at the end", state_shade});
  const bool png = output.ends_with(".png");
  const int width = panels.size() > 1 ? 940 : 620;
  std::string text = fmt::format(
      "# Drawn by: gnuplot THIS_FILE\nset terminal {}\n{}"
      "set multiplot title {} noenhanced\n"
      "set encoding utf8\nset xlabel {} noenhanced\nset tics out nomirror\nset border 3\n",
      png ? fmt::format("pngcairo size {},600 font 'Sans,11' fontscale 1.3 background rgb 'white'",
                        width * 3 / 2)
          : fmt::format("svg size {},400 dynamic enhanced font 'Helvetica, Arial, sans-serif,12' "
                        "background rgb 'white'",
                        width),
      output_line(output),
      gnuplot_text(fmt::format("{}{}: {}, {} steps a cell", map.model,
                               map.scene.empty() ? "" : ", " + map.scene, greek_text(map.method),
                               map.steps)),
      gnuplot_text(axis_label(map.axes[0])));
  text += range_text('x', map.axes[0], borders(map.axes[0])) + range_text('y', down, borders(down));
  if (map.axes.size() == 1) text += "unset ytics\n";
  if (!map.linear_bound.empty()) {
    text += "$bound << EOD\n";
    for (const auto& point : map.linear_bound)
      text += fmt::format("{:.9g} {:.9g}\n", point[0], point[1]);
    text += "EOD\n";
  }
  // Equal panels between margins in pixels, and the key of both to the right of the last.
  constexpr double left = 68.0;
  constexpr double gap = 50.0;
  constexpr double key = 175.0;
  const auto count = static_cast<double>(panels.size());
  const double share = (width - left - key - gap * (count - 1.0)) / count;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double begin = left + (share + gap) * static_cast<double>(i);
    const bool is_last = i + 1 == panels.size();
    text += fmt::format(
        "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n"
        "set tmargin at screen 0.83\nset bmargin at screen 0.16\n"
        "set title {}\nset ylabel {} noenhanced\n",
        begin / width, (begin + share) / width, gnuplot_text(panels[i].title),
        gnuplot_text(i == 0 ? axis_label(down) : ""));
    text += is_last ? fmt::format(
                          "set key at screen {:.4f},0.83 left top Left reverse noenhanced "
                          "samplen 1.5\n",
                          (width - key + 12.0) / width)
                    : "unset key\n";
    text +=
        panel_text(map, down, panels[i], is_last ? shades_of(map, panels) : std::vector<bool>());
  }
  return text + "unset multiplot\nunset output\n";
}

}  // namespace hamgen::app
