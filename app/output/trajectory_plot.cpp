#include "app/output/trajectory_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "app/output/envelope.hpp"
#include "app/output/math_symbol.hpp"
#include "app/output/plain_number.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/pieces.hpp"

namespace hamgen::app {
namespace {

constexpr const char* kEnergyErrorColumn = "energy_error";
constexpr std::size_t kMostLines = 8;  // in a panel

class TrajectoryPlotter {
 public:
  TrajectoryPlotter(const NumberTable& table, const std::string& title)
      : table_(table), title_(title) {
    for (const char* name : {"H", "H+p_t"}) {
      if (!energy_) energy_ = find(name);
    }
  }

  Plot named(const std::string& columns) {
    for (const std::string_view piece : outermost_pieces(columns)) {
      const std::string text(without_blanks(piece));
      const bool is_column = find(text).has_value();  // as "H+p_t" is
      const std::vector<std::string> curves =
          is_column ? std::vector{text} : pieces_between(text, '+');
      if (curves.size() > 1) {
        together(curves);
      } else {
        add(pieces_between(text, ':'));
      }
    }
    return finish();
  }

  Plot usual() {
    const auto [q, p] = state_names();
    const std::size_t n = q.size();
    if (n == 1) across({{q[0], p[0]}});
    if (n == 2 || n == 3) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) across({{q[i], q[j]}});
      }
    }
    if (n > 3) over_time(q, "coordinates");
    if (n > 0) over_time(p, "momenta");
    if (n == 0) over_time(others(), "");
    if (n == 0 && others().empty())
      throw UsageError(fmt::format(
          "no trajectory: what is drawn stands behind the time, in the third column and those "
          "after it, and there are {}{}",
          fmt::join(table_.columns, ", "),
          table_.columns.size() < 2 ? ""
                                    : "\nhelp: one over the other: --columns " + table_.columns[1] +
                                          ":" + table_.columns[0]));
    if (energy_) over_time({kEnergyErrorColumn}, "energy error");
    return finish();
  }

 private:
  std::optional<std::size_t> find(const std::string& name) const {
    const auto it = std::ranges::find(table_.columns, name);
    if (it == table_.columns.end()) return {};
    return static_cast<std::size_t>(it - table_.columns.begin());
  }

  std::size_t place_of_column(const std::string& name) const {
    if (const auto place = find(name)) return *place;
    std::vector<std::string> names = table_.columns;
    if (energy_) names.emplace_back(kEnergyErrorColumn);
    const std::string near = nearest(name, names);
    throw UsageError(fmt::format("--columns: there is no '{}'\nhelp: {}", name,
                                 near.empty() ? fmt::format("there are {}", fmt::join(names, ", "))
                                              : fmt::format("did you mean '{}'?", near)));
  }

  std::vector<double> values_of(const std::string& name) const {
    return values_of(name, table_.rows);
  }
  // Of the rows, or of the least or the greatest between them.
  std::vector<double> values_of(const std::string& name,
                                const std::vector<std::vector<double>>& rows) const {
    const bool is_error = name == kEnergyErrorColumn && energy_ && !find(name);
    const std::size_t place = is_error ? *energy_ : place_of_column(name);
    std::vector<double> values;
    const double scale = is_error ? table_.energy_scale.value_or(1.0) : 1.0;
    for (const std::vector<double>& row : rows)
      values.push_back((row[place] - (is_error ? table_.rows.front()[place] : 0.0)) / scale);
    return values;
  }

  // Behind step and t, before H: q then p, without the model's own time and its momentum, the last.
  struct StateNames {
    std::vector<std::string> q, p;
  };
  StateNames state_names() const {
    const std::size_t first = 2;
    if (!energy_ || *energy_ <= first || (*energy_ - first) % 2 != 0) return {};
    const auto begin = table_.columns.begin() + first;
    const auto end = table_.columns.begin() + static_cast<std::ptrdiff_t>(*energy_);
    const auto middle = begin + (end - begin) / 2;
    const std::ptrdiff_t times = *end == "H+p_t" ? 1 : 0;
    return {{begin, middle - times}, {middle, end - times}};
  }
  std::vector<std::string> others() const {
    std::vector<std::string> names;
    for (std::size_t i = 2; i < table_.columns.size(); ++i) {
      if (i != energy_) names.push_back(table_.columns[i]);
    }
    return names;
  }

  // Rows that were left out between two make a line through them mean nothing, unless they are
  // near.
  PlotSeries series(const std::string& label, const std::vector<double>& x,
                    const std::vector<double>& y, int colour) const {
    const bool is_curve = table_.each == 1 || (is_near_to_next(x) && is_near_to_next(y));
    PlotSeries result{.label = label,
                      .points = {},
                      .style = is_curve ? PlotStyle::lines : PlotStyle::dots,
                      .colour = colour};
    for (std::size_t i = 0; i < x.size(); ++i) result.points.push_back({x[i], y[i]});
    return result;
  }

  struct ValuesBetween {
    std::vector<double> values, low, high;
  };
  ValuesBetween values_between(const std::string& name) const {
    return {values_of(name), values_of(name, table_.low), values_of(name, table_.high)};
  }

  // The least and the greatest in spans of a pixel.
  static PlotSeries band_of(const std::vector<double>& times, const std::vector<double>& low,
                            const std::vector<double>& high) {
    constexpr std::size_t spans = 400;
    const std::size_t rows = (times.size() + spans - 1) / spans;  // in each
    PlotSeries band{.label = "", .points = {}, .style = PlotStyle::band};
    for (std::size_t from = 0; from < times.size(); from += rows) {
      const std::size_t to = std::min(times.size(), from + rows);
      PlotPoint point{.x = times[from + (to - from) / 2], .y = high[from], .low = low[from]};
      for (std::size_t i = from; i < to; ++i) {
        point.y = std::fmax(point.y, high[i]);
        point.low = std::fmin(point.low, low[i]);
      }
      if (std::isfinite(point.y) && std::isfinite(point.low)) band.points.push_back(point);
    }
    return band;
  }

  // By more than a ripple: more than once in four pixels, or between two of the rows that were
  // kept.
  static bool turns_often(const std::vector<double>& values, const std::vector<double>& low,
                          const std::vector<double>& high) {
    constexpr long most = 100;
    constexpr double seen = 0.1;
    constexpr double ripple = 0.05;
    if (values.empty()) return false;
    const double range = std::ranges::max(high) - std::ranges::min(low);
    long turns = 0;
    bool rises = false;
    double extreme = values[0];  // since it turned
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (high[i] - low[i] > seen * range) return true;
      const double on = rises ? values[i] - extreme : extreme - values[i];
      if (on < -ripple * range) {
        rises = !rises;
        ++turns;
      }
      if (on > 0.0 || on < -ripple * range) extreme = values[i];
    }
    return turns > most;
  }

  // No value is farther from the next than so much of their range.
  static bool is_near_to_next(const std::vector<double>& values) {
    constexpr double near = 0.1;
    if (values.empty()) return true;
    double largest = 0.0;
    for (std::size_t i = 1; i < values.size(); ++i)
      largest = std::max(largest, std::fabs(values[i] - values[i - 1]));
    const auto [low, high] = std::ranges::minmax(values);
    return largest <= near * (high - low);
  }

  static std::vector<std::string> pieces_between(std::string text, char separator) {
    std::vector<std::string> pieces;
    for (std::size_t at; (at = text.find(separator)) != std::string::npos;) {
      pieces.emplace_back(without_blanks(text.substr(0, at)));
      text.erase(0, at + 1);
    }
    pieces.emplace_back(without_blanks(text));
    return pieces;
  }

  struct Curve {
    std::string x, y;
  };

  // The name of an axis: of the column, or of the array whose elements they all are.
  static std::string label_of(const std::vector<Curve>& curves, std::string Curve::*axis) {
    const std::string& first = curves[0].*axis;
    if (curves.size() == 1) return plain_symbol(first);
    const std::string array = first.substr(0, first.find('['));
    const bool is_one = std::ranges::all_of(curves, [&](const Curve& curve) {
      return (curve.*axis).starts_with(array + "[") || curve.*axis == first;
    });
    return plain_symbol(is_one ? array : first) + (is_one ? "" : ", ...");
  }

  // One over another in one panel; two coordinates of a space have the same unit.
  void across(const std::vector<Curve>& curves) {
    const std::vector<std::string> q = state_names().q;
    const auto is_coordinate = [&q](const std::string& name) {
      return std::ranges::find(q, name) != q.end();
    };
    const bool one = curves.size() == 1;
    PlotPanel panel{.title = title(one ? curves[0].y + " over " + curves[0].x : "orbits"),
                    .x_label = label_of(curves, &Curve::x),
                    .y_label = label_of(curves, &Curve::y),
                    .square = true,
                    .series = {}};
    for (const auto& [x, y] : curves) {
      panel.square = panel.square && is_coordinate(x) && is_coordinate(y);
      panel.series.push_back(
          series(one ? "" : x, values_of(x), values_of(y), static_cast<int>(panel.series.size())));
    }
    panel.square = panel.square && suits_one_unit(panel);
    plot_.panels.push_back(std::move(panel));
  }

  // "a:b" and "c:d", from "a:b+c:d"; or columns over time.
  void together(const std::vector<std::string>& texts) {
    if (texts.size() > kMostLines)
      throw UsageError(fmt::format("--columns: {} curves in one picture; {} are the most",
                                   texts.size(), kMostLines));
    std::vector<Curve> curves;
    for (const std::string& text : texts) {
      const std::vector<std::string> axes = pieces_between(text, ':');
      if (axes.size() == 2) curves.push_back({axes[0], axes[1]});
    }
    if (curves.empty() && std::ranges::none_of(texts, has_axes))
      return over_time(texts, fmt::format("{}", fmt::join(texts, ", ")));
    if (curves.size() != texts.size())
      throw UsageError(fmt::format(
          "--columns {}: curves in one picture are of one kind\nhelp: a:b+c:d, or a+b over time",
          fmt::join(texts, "+")));
    across(curves);
  }

  static bool has_axes(const std::string& text) { return text.find(':') != std::string::npos; }

  void over_time(const std::vector<std::string>& names, const std::string& what) {
    if (names.empty()) return;
    const std::string& time = table_.columns[std::min<std::size_t>(1, table_.columns.size() - 1)];
    const std::vector<double> times = values_of(time);
    const bool one = names.size() == 1;
    const bool is_error = one && names.front() == kEnergyErrorColumn;
    PlotPanel panel{.title = title(is_error       ? "energy error"
                                   : what.empty() ? names.front()
                                                  : what),
                    .x_label = time,
                    .y_label = is_error ? energy_error_label()
                               : one    ? plain_symbol(names.front())
                                        : what,
                    .series = {}};
    bool is_range = false;
    for (std::size_t i = 0; i < std::min(names.size(), kMostLines); ++i) {
      const std::string label = one ? "" : plain_symbol(names[i]);
      const int colour = static_cast<int>(i);
      const auto [values, low, high] = values_between(names[i]);
      const bool is_sorted = std::ranges::is_sorted(times);
      if (!is_sorted || !turns_often(values, low, high)) {
        panel.series.push_back(series(label, times, values, colour));
        // The rows between two that were kept are near them.
        if (is_sorted) panel.series.back().style = PlotStyle::lines;
        continue;
      }
      PlotSeries band = band_of(times, low, high);
      band.label = label;
      band.colour = colour;
      std::ranges::move(one ? envelope(band) : envelope_edges(band),
                        std::back_inserter(panel.series));
      is_range = true;
    }
    if (is_range) panel.title += ", least to greatest";
    plot_.panels.push_back(std::move(panel));
  }

  std::string energy_error_label() const {
    if (!table_.energy_scale) return "H − H(0)";
    return "H − H(0), relative to " + plain_number(*table_.energy_scale, 3);
  }

  // The diagonal of the axes is the line of sight: each leaves it by 120 degrees from the others.
  void along_diagonal(const std::vector<std::string>& names) {
    std::array<std::vector<double>, 3> values;
    std::array<double, 3> low{}, high{};
    for (std::size_t i = 0; i < 3; ++i) {
      values[i] = values_of(names[i]);
      low[i] = std::numeric_limits<double>::infinity();
      high[i] = -low[i];
      for (const double value : values[i]) {
        if (!std::isfinite(value)) continue;
        low[i] = std::min(low[i], value);
        high[i] = std::max(high[i], value);
      }
    }
    const auto seen = [](const std::array<double, 3>& point) {
      return PlotPoint{std::sqrt(0.75) * (point[1] - point[0]),
                       point[2] - 0.5 * (point[0] + point[1])};
    };
    PlotPanel panel{.title = title(fmt::format("{}", fmt::join(names, ", "))),
                    .x_label = "seen along the diagonal",
                    .y_label = "",
                    .square = true,
                    .series = {series("", {}, {}, 0)}};
    for (std::size_t k = 0; k < table_.rows.size(); ++k)
      panel.series[0].points.push_back(seen({values[0][k], values[1][k], values[2][k]}));
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<double, 3> end = low;
      end[i] = high[i];
      panel.series.push_back({.label = names[i],
                              .points = {seen(low), seen(end)},
                              .style = PlotStyle::lines,
                              .colour = static_cast<int>(i) + 1});
    }
    plot_.panels.push_back(std::move(panel));
  }

  void add(const std::vector<std::string>& names) {
    if (names.size() == 1) return over_time(names, "");
    if (names.size() == 2) return across({{names[0], names[1]}});
    if (names.size() == 3) return along_diagonal(names);
    throw UsageError(fmt::format("--columns {}: more than three axes\nhelp: a, a:b or a:b:c",
                                 fmt::join(names, ":")));
  }

  std::string title(const std::string& what) const {
    return plot_.panels.empty() ? title_ + ": " + what : what;
  }

  Plot finish() {
    if (plot_.panels.size() > 2) plot_.width = 440;
    return std::move(plot_);
  }

  const NumberTable& table_;
  std::string title_;
  std::optional<std::size_t> energy_;
  Plot plot_;
};

}  // namespace

Plot trajectory_plot(const NumberTable& table, const std::string& columns,
                     const std::string& title) {
  TrajectoryPlotter plotter(table, title);
  return columns.empty() ? plotter.usual() : plotter.named(columns);
}

void require_columns(const std::vector<std::string>& names, const std::string& columns) {
  NumberTable empty;
  empty.columns = names;
  static_cast<void>(trajectory_plot(empty, columns, ""));
}

void require_picture_name(const std::string& option, const std::string& path) {
  if (path.ends_with(".svg") || path.ends_with(".png")) return;
  throw UsageError(fmt::format("{} {}: a picture's name ends in .svg or .png", option, path));
}

}  // namespace hamgen::app
