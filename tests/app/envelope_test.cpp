// What oscillates more quickly than a picture shows is drawn from its least to its greatest, and
// not as what a choice of its rows happens to be.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/output/trajectory_plot.hpp"

namespace hamgen::app_test {
namespace {

using app::NumberTable;
using app::PlotPanel;
using app::PlotPoint;
using app::PlotSeries;
using app::PlotStyle;

// A swing of one degree of freedom of size 1 + t/4, t from 0 to 1.
PlotPanel momenta_of(long rows, double rows_in_a_turn) {
  NumberTable table;
  table.columns = {"step", "t", "q", "p", "H"};
  for (long i = 0; i <= rows; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(rows);
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / rows_in_a_turn;
    const double size = 1.0 + t / 4.0;
    table.add({static_cast<double>(i), t, size * std::cos(angle), size * std::sin(angle), 0.5});
  }
  return app::trajectory_plot(table, "p", "swing").panels[0];
}

// Every second, fourth, ... row of 1000 turns is a slow wave, and so are 2000 of them.
TEST(Envelope, IsOfAllRowsAndNotOfThoseThatAreKept) {
  for (const auto& [rows, in_a_turn] :
       {std::pair{64'000L, 64.02}, {64'000L, 31.9}, {1'900L, 2.1}, {1'900L, 7.0}}) {
    const PlotPanel panel = momenta_of(rows, in_a_turn);
    EXPECT_EQ(panel.title, "swing: p, least to greatest");
    ASSERT_EQ(panel.series.size(), 3U) << rows << ' ' << in_a_turn;
    EXPECT_EQ(panel.series[0].style, PlotStyle::band);
    // A span is no more than 1/20 of the whole wide, where the size changes by 1/80; a turn of few
    // rows misses its own greatest value by 1 - cos(pi/7).
    for (const PlotPoint& point : panel.series[0].points) {
      EXPECT_NEAR(point.y, 1.0 + point.x / 4.0,
                  1.25 * (1.0 - std::cos(std::numbers::pi / 7.0)) + 1.0 / 80);
      EXPECT_NEAR(point.low, -point.y, 0.05) << point.x;
    }
    const auto [upper, lower] = std::pair{panel.series[1], panel.series[2]};
    EXPECT_EQ(upper.style, PlotStyle::lines);
    EXPECT_LT(upper.points.front().y, upper.points.back().y);
    EXPECT_GT(lower.points.front().y, lower.points.back().y);
  }
}

TEST(Envelope, IsNotOfWhatAPictureShows) {
  NumberTable ripple;
  ripple.columns = {"step", "t", "x"};
  for (long i = 0; i < 1'900; ++i) {
    const double x = static_cast<double>(i);
    ripple.add({x, x, std::sin(0.01 * x) + 0.02 * std::sin(2.0 * x)});
  }
  EXPECT_EQ(app::trajectory_plot(ripple, "x", "").panels[0].series.size(), 1U);
  for (const auto& [rows, in_a_turn] : {std::pair{1'900L, 100.0}, {64'000L, 20'000.0}}) {
    const PlotPanel panel = momenta_of(rows, in_a_turn);
    EXPECT_EQ(panel.title, "swing: p");
    ASSERT_EQ(panel.series.size(), 1U);
    EXPECT_EQ(panel.series[0].style, PlotStyle::lines);
  }
}

// A slow course under a quick ripple keeps its shape: the band is as wide as the ripple.
TEST(Envelope, IsNoWiderThanItsRipple) {
  NumberTable table;
  table.columns = {"step", "t", "x"};
  for (long i = 0; i < 100'000; ++i) {
    const double t = 1e-5 * static_cast<double>(i);
    table.add({static_cast<double>(i), t,
               std::sin(2.0 * std::numbers::pi * t) + 0.15 * std::sin(static_cast<double>(i))});
  }
  const std::vector<PlotSeries> series = app::trajectory_plot(table, "x", "").panels[0].series;
  ASSERT_EQ(series.size(), 3U);
  // The ripple is 0.3 from crest to trough; the course changes by 2 pi/400 in a span of which
  // there are three.
  for (const PlotPoint& point : series[0].points)
    EXPECT_LT(point.y - point.low, 0.3 + 4.0 * 2.0 * std::numbers::pi / 400);
}

// Of several only the edges: an area would hide those behind it.
TEST(Envelope, OfSeveralIsTheirEdges) {
  NumberTable table;
  table.columns = {"step", "t", "a", "b"};
  for (long i = 0; i < 2'000; ++i) {
    const double x = static_cast<double>(i);
    table.add({x, x, std::sin(x), 2.0 * std::cos(x)});
  }
  const PlotPanel panel = app::trajectory_plot(table, "a+b", "").panels[0];
  ASSERT_EQ(panel.series.size(), 4U);
  for (const PlotSeries& series : panel.series) EXPECT_EQ(series.style, PlotStyle::lines);
  EXPECT_EQ(panel.series[0].label, "a");
  EXPECT_EQ(panel.series[1].label, "");
  EXPECT_EQ(panel.series[2].label, "b");
  EXPECT_EQ(panel.series[1].colour, panel.series[0].colour);
}

}  // namespace
}  // namespace hamgen::app_test
