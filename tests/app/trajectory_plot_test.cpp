// What `hamgen run --plot` shows without being told, and how far its axes share a unit.
#include "app/output/trajectory_plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

using app::NumberTable;
using app::Plot;
using app::PlotPanel;
using app::PlotStyle;

// A circle in x, y, flattened to z.
NumberTable circle() {
  NumberTable table;
  table.columns = {"step", "t", "x", "y", "z", "u", "v", "w", "H"};
  for (int i = 0; i <= 100; ++i) {
    const double t = 2.0 * std::numbers::pi * i / 100.0;
    table.add({static_cast<double>(i), t, std::cos(t), std::sin(t), 0.01 * std::sin(2.0 * t),
               -std::sin(t), std::cos(t), 0.02 * std::cos(2.0 * t), 0.5});
  }
  return table;
}

TEST(TrajectoryPlot, SharesAUnitUnlessAPictureWouldBeAStrip) {
  const Plot plot = app::trajectory_plot(circle(), "", "circle");
  ASSERT_EQ(plot.panels.size(), 5U);  // three planes, momenta, energy
  EXPECT_TRUE(plot.panels[0].square);
  EXPECT_EQ(plot.panels[1].title, "z over x");
  EXPECT_FALSE(plot.panels[1].square);
  EXPECT_FALSE(plot.panels[2].square);
}

// The model's own time is no place: a driven oscillator is drawn as one of one degree of freedom.
TEST(TrajectoryPlot, HasNoAxisForTheTimeOfADrivenSystem) {
  NumberTable table;
  table.columns = {"step", "elapsed", "q", "t", "p", "p_t", "H+p_t"};
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.1 * i;
    table.add({static_cast<double>(i), t, std::cos(t), t, -std::sin(t), 0.1 * std::cos(t), 0.5});
  }
  const Plot plot = app::trajectory_plot(table, "", "driven");
  ASSERT_EQ(plot.panels.size(), 3U);
  EXPECT_EQ(plot.panels[0].x_label, "q");
  EXPECT_EQ(plot.panels[0].y_label, "p");
  ASSERT_EQ(plot.panels[1].series.size(), 1U);
  EXPECT_EQ(plot.panels[1].series[0].label, "");  // p alone
}

// Rows that were left out between two lie near them: what does not turn often is a line.
TEST(TrajectoryPlot, JoinsTheRowsThatAreKeptOverTime) {
  NumberTable table;
  table.columns = {"step", "t", "a"};
  for (int i = 0; i < 2100; ++i)  // 45 turns, every second row kept
    table.add(
        {static_cast<double>(i), 1.0 * i, std::sin(2.0 * std::numbers::pi * i * 45.0 / 2100.0)});
  ASSERT_GT(table.each, 1);
  const PlotPanel panel = app::trajectory_plot(table, "a", "").panels[0];
  ASSERT_EQ(panel.series.size(), 1U);
  EXPECT_EQ(panel.series[0].style, PlotStyle::lines);
}

// Numbers on a short axis do not run into each other.
TEST(TrajectoryPlot, NarrowPicturesHaveFewerNumbersOnTheirAxis) {
  Plot plot{.panels = {{.title = "",
                        .x_label = "x",
                        .y_label = "z",
                        .series = {{.label = "", .points = {{-0.7, 0.01}, {0.9, 0.02}}}}}},
            .width = 360,
            .height = 360};
  EXPECT_TRUE(contains(app::gnuplot_script(plot, "m.svg"), "set xtics 0.5\n"));
  plot.width = 560;
  EXPECT_FALSE(contains(app::gnuplot_script(plot, "m.svg"), "set xtics 0.5\n"));
}

}  // namespace
}  // namespace hamgen::app_test
