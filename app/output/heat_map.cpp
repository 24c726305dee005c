#include "app/output/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/output/gnuplot.hpp"
#include "generator/base/quoted_text.hpp"

namespace hamgen::app {
namespace {

double spacing(const std::vector<double>& values) {
  return values.size() > 1 ? values[1] - values[0] : 1.0;
}

std::string range_of(const std::vector<double>& values) {
  const double half = 0.5 * spacing(values);
  return fmt::format("[{:.9g}:{:.9g}]", values.front() - half, values.back() + half);
}

}  // namespace

std::string heat_map_script(const HeatMap& map, const std::string& output) {
  std::string text = script_head(output, 760, 600);
  text += "$cells << EOD\n";
  for (std::size_t j = 0; j < map.y.size(); ++j) {
    for (std::size_t i = 0; i < map.x.size(); ++i) {
      const std::optional<double>& value = map.values[j * map.x.size() + i];
      if (value)
        text += fmt::format("{:.9g} {:.9g} {:.9g}\n", map.x[i], map.y[j],
                            std::clamp(*value, map.low, map.high));
    }
  }
  text += "EOD\n";
  text += fmt::format(
      "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n"
      "set cblabel {} noenhanced\n"
      "set xrange {}\nset yrange {}\nset cbrange [{:.9g}:{:.9g}]\nunset grid\nunset key\n"
      "set object rectangle from graph 0,0 to graph 1,1 behind fc rgb '#BBBBBB' fs noborder\n"
      // Viridis: even steps of brightness, for colour-blind readers and in grey print too.
      "set palette defined (0 '#440154', 1 '#3B528B', 2 '#21918C', 3 '#5EC962', 4 '#FDE725')\n"
      "set style fill solid 1 noborder\nset boxwidth 1\n",
      gnuplot_text(map.title), gnuplot_text(map.x_label), gnuplot_text(map.y_label),
      gnuplot_text(map.value_label), range_of(map.x), range_of(map.y), map.low, map.high);
  text += fmt::format(
      "plot $cells using 1:2:({0:.9g}):({1:.9g}):3 with boxxyerror fc palette\nunset output\n",
      0.5 * spacing(map.x), 0.5 * spacing(map.y));
  return text;
}

}  // namespace hamgen::app
