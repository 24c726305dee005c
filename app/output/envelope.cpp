#include "app/output/envelope.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace hamgen::app {
namespace {

// The least and the greatest of each point and so many on both sides.
std::vector<PlotPoint> widened(const std::vector<PlotPoint>& points, std::ptrdiff_t around) {
  std::vector<PlotPoint> result = points;
  const auto size = static_cast<std::ptrdiff_t>(points.size());
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    const auto begin = points.begin() + std::max<std::ptrdiff_t>(0, i - around);
    const auto end = points.begin() + std::min(size, i + around + 1);
    PlotPoint& point = result[static_cast<std::size_t>(i)];
    point.y = std::ranges::max_element(begin, end, {}, &PlotPoint::y)->y;
    point.low = std::ranges::min_element(begin, end, {}, &PlotPoint::low)->low;
  }
  return result;
}

// How often an edge goes from rising to falling or back; level parts do not count.
std::size_t turns(const std::vector<PlotPoint>& points, double PlotPoint::*edge) {
  std::size_t count = 0;
  double before = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double now = points[i].*edge - points[i - 1].*edge;
    if (now == 0.0) continue;
    count += now * before < 0.0 ? 1 : 0;
    before = now;
  }
  return count;
}

std::vector<PlotPoint> filled(const std::vector<PlotPoint>& points) {
  constexpr std::ptrdiff_t widest = 8;
  const std::size_t most = points.size() / 10;
  std::vector<PlotPoint> result = widened(points, 1);
  for (std::ptrdiff_t around = 2; around <= widest; ++around) {
    if (turns(result, &PlotPoint::y) <= most && turns(result, &PlotPoint::low) <= most) break;
    result = widened(points, around);
  }
  return result;
}

PlotSeries edge_of(const PlotSeries& band, double PlotPoint::*edge) {
  PlotSeries line{.label = "", .points = {}, .style = PlotStyle::lines, .colour = band.colour};
  for (const PlotPoint& point : band.points) line.points.push_back({point.x, point.*edge});
  return line;
}

}  // namespace

std::vector<PlotSeries> envelope(const PlotSeries& band) {
  PlotSeries area = band;
  area.style = PlotStyle::band;
  area.points = filled(band.points);
  PlotSeries upper = edge_of(area, &PlotPoint::y);
  PlotSeries lower = edge_of(area, &PlotPoint::low);
  return {std::move(area), std::move(upper), std::move(lower)};
}

std::vector<PlotSeries> envelope_edges(const PlotSeries& band) {
  std::vector<PlotSeries> series = envelope(band);
  series[1].label = band.label;
  series.erase(series.begin());
  return series;
}

}  // namespace hamgen::app
