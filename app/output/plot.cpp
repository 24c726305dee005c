#include "app/output/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>

#include "generator/base/diagnostic.hpp"
#include "generator/base/quoted_text.hpp"
#include "runtime/atomic_file.hpp"
#include "runtime/process.hpp"
#include "runtime/temporary_directory.hpp"
#include "runtime/temporary_name.hpp"
#include "runtime/tool_error.hpp"

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
  const double room = range.high > range.low ? 0.04 * (range.high - range.low)
                                             : std::max(1e-12, 0.1 * std::fabs(range.high));
  return {range.low - room, range.high + room};
}

// Where a value lies between the ends of its axis, 0 to 1.
double place(double value, const Range& range, bool logarithmic) {
  if (!logarithmic) return (value - range.low) / (range.high - range.low);
  return std::log(value / range.low) / std::log(range.high / range.low);
}

struct EndLabel {
  std::string text;
  double height = 0.0;  // in the panel, 0 to 1
  std::size_t series = 0;
};

// Labels beside the ends of their lines, moved apart so that none covers another.
std::vector<EndLabel> end_labels(const PlotPanel& panel, const Range& y, double distance) {
  std::vector<EndLabel> labels;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const PlotSeries& series = panel.series[i];
    std::optional<PlotPoint> last;
    for (const PlotPoint& point : series.points) {
      if (drawable(panel, point) && (!last || point.x >= last->x)) last = point;
    }
    if (last && !series.label.empty())
      labels.push_back({series.label, place(last->y, y, panel.logarithmic_y), i});
  }
  std::ranges::sort(labels, {}, &EndLabel::height);
  for (std::size_t i = 1; i < labels.size(); ++i)
    labels[i].height = std::max(labels[i].height, labels[i - 1].height + distance);
  double ceiling = 1.0;
  for (std::size_t i = labels.size(); i-- > 0; ceiling = labels[i].height - distance)
    labels[i].height = std::min(labels[i].height, ceiling);
  return labels;
}

std::size_t colour_of(const PlotPanel& panel, std::size_t i) {
  const int chosen = panel.series[i].colour;
  return (chosen >= 0 ? static_cast<std::size_t>(chosen) : i) % kColours.size();
}

std::string style_text(const PlotPanel& panel, std::size_t i) {
  const std::size_t colour = colour_of(panel, i);
  const bool points = panel.series[i].style == PlotStyle::points;
  const bool lines = panel.series[i].style == PlotStyle::lines;
  const std::string line = fmt::format("lc rgb '{}' lw 1.6 dt {}", kColours[colour],
                                       kDashes[lines ? 0 : i % kDashes.size()]);
  switch (panel.series[i].style) {
    case PlotStyle::lines:
      return "with lines " + line;
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
    text += fmt::format("$data_{}_{} << EOD\n", number, i);
    for (const PlotPoint& point : panel.series[i].points) {
      if (drawable(panel, point)) text += fmt::format("{:.9g} {:.9g}\n", point.x, point.y);
    }
    text += "EOD\n";
  }
  return text;
}

bool has_points(const PlotPanel& panel, std::size_t i) {
  return std::ranges::any_of(panel.series[i].points,
                             [&panel](const auto& point) { return drawable(panel, point); });
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

std::string panel_text(const PlotPanel& panel, std::size_t number, int width, int height) {
  Range x;
  Range y;
  for (const PlotSeries& series : panel.series) {
    for (const PlotPoint& point : series.points) {
      if (!drawable(panel, point)) continue;
      x = {std::min(x.low, point.x), std::max(x.high, point.x)};
      y = {std::min(y.low, point.y), std::max(y.high, point.y)};
    }
  }
  x = padded(x, panel.logarithmic_x);
  y = padded(y, panel.logarithmic_y);
  const std::vector<EndLabel> labels = end_labels(panel, y, 18.0 / (0.78 * height));
  std::size_t longest = 0;
  for (const EndLabel& label : labels) longest = std::max(longest, label.text.size());

  std::string text = fmt::format(
      "\nset title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n",
      gnuplot_text(panel.title), gnuplot_text(panel.x_label), gnuplot_text(panel.y_label));
  const auto axis = [](char name, bool logarithmic, const Range& range) {
    const double decades = std::log10(range.high / range.low);
    return fmt::format(
        "{0} logscale {1}\nset format {1} '{2}'\nset xtics autofreq\nset {1}tics {4}\nset {1}range "
        "[{3}]\n",
        logarithmic ? "set" : "unset", name, logarithmic ? "10^{%L}" : "%.6g",
        fmt::format("{:.9g}:{:.9g}", range.low, range.high),
        logarithmic && decades > 8.0 ? std::string("100") : std::string("autofreq"));
  };
  text += axis('x', panel.logarithmic_x, x) + axis('y', panel.logarithmic_y, y);
  text += panel.square ? "set size ratio -1\n" + square_tics(x, y, width, height)
                       : std::string("set size noratio\n");
  text += fmt::format("set rmargin {}\nunset label\n",
                      longest == 0 ? 3.0 : 5.0 + 0.78 * static_cast<double>(longest));
  for (const EndLabel& label : labels) {
    const std::string_view colour = kColours[colour_of(panel, label.series)];
    text += fmt::format(
        "set label {} at graph 1.03, graph {:.4f} noenhanced textcolor rgb '{}' point lc rgb '{}' "
        "pt {} ps 0.7 offset 0.8,0\n",
        gnuplot_text(label.text), label.height, colour, colour,
        kMarkers[label.series % kMarkers.size()]);
  }
  std::string plots;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    if (!has_points(panel, i)) continue;
    plots += fmt::format("{}$data_{}_{} using 1:2 notitle {}", plots.empty() ? "" : ", \\\n     ",
                         number, i, style_text(panel, i));
  }
  return text + (plots.empty() ? "plot NaN notitle\n" : "plot " + plots + "\n");
}

// The script with another output.
std::string with_output(std::string script, const std::filesystem::path& output) {
  const std::size_t begin = script.find("set output ");
  if (begin == std::string::npos) internal_error("a script without an output");
  const std::size_t end = script.find('\n', begin);
  return script.replace(begin, end - begin, "set output " + gnuplot_path(output.string()));
}

// Under a temporary name until it is published.
class Aside {
 public:
  explicit Aside(const std::filesystem::path& picture)
      : picture_(picture), path_(runtime::temporary_name(picture)) {}
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;
  ~Aside() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool publish() const {
    std::error_code failed;
    std::filesystem::rename(path_, picture_, failed);
    return !failed;
  }

 private:
  std::filesystem::path picture_;
  std::filesystem::path path_;
};

// Gnuplot does not mind a full disk.
bool is_whole(const std::filesystem::path& picture) {
  const std::string text = runtime::read_file(picture);
  if (text.starts_with("\x89PNG")) return text.ends_with("IEND\xAE\x42\x60\x82");
  return text.substr(0, text.find_last_not_of('\n') + 1).ends_with("</svg>");
}

}  // namespace

std::string script_head(const std::string& output, int width, int height) {
  const bool png = output.ends_with(".png");
  const int factor = png ? 2 : 1;  // for sharp screens and print
  return fmt::format(
      "# Drawn by: gnuplot THIS_FILE\n"
      "set terminal {} size {},{} enhanced font '{},{}' background rgb 'white'{}\n"
      "set output {}\n"
      "set border 3 lc rgb '#555555'\nset tics nomirror out scale 0.6\n"
      "set grid lc rgb '#DDDDDD' lw 0.6 dt 1\nset samples 2\n",
      png ? "pngcairo" : "svg", factor * width, factor * height,
      png ? "Sans" : "Helvetica, Arial, sans-serif", png ? 11 : 14,
      png ? " fontscale 1.7 linewidth 2 pointscale 2" : " dynamic", gnuplot_path(output));
}

std::string gnuplot_script(const Plot& plot, const std::string& output) {
  const std::size_t count = plot.panels.size();
  std::string text = script_head(output, plot.width * static_cast<int>(count), plot.height);
  for (std::size_t i = 0; i < count; ++i) text += data_block(plot.panels[i], i);
  text += fmt::format("set multiplot layout 1,{}\n", count);
  for (std::size_t i = 0; i < count; ++i)
    text += panel_text(plot.panels[i], i, plot.width, plot.height);
  return text + "unset multiplot\nunset output\n";
}

std::string run_gnuplot(const std::string& script, const std::filesystem::path& picture,
                        StopFlag stop) {
  try {
    const runtime::TemporaryDirectory directory = runtime::private_directory();
    const Aside aside(picture);
    const std::filesystem::path file = directory.path() / "script.gp";
    runtime::atomic_write(file, with_output(script, aside.path()));
    runtime::ProcessRequest request;
    request.command = {"gnuplot", file.string()};
    request.stop = stop;
    const runtime::ProcessResult result = runtime::run_process(request);
    if (!result.succeeded())
      return fmt::format("gnuplot: {}\n{}", runtime::end_text(result, request),
                         runtime::tail_of(result.output));
    if (!is_whole(aside.path())) return "gnuplot did not write all of it: is the disk full?";
    return aside.publish() ? "" : fmt::format("cannot write '{}'", picture.string());
  } catch (const runtime::ToolError& error) {
    const runtime::ToolFailure& failure = error.failure();
    const bool was_called = !failure.command.empty();
    return (was_called ? "gnuplot could not be started: " : "") + failure.message;
  }
}

}  // namespace hamgen::app
