// Oscillations too quick to be told apart in a picture: what they fill.
#pragma once

#include <vector>

#include "app/output/plot.hpp"

namespace hamgen::app {

// Of the least and the greatest in each of many short spans, as the points of `band`, what lies
// between them and the two edges as lines.  Where a span holds no whole oscillation they are those
// of the spans around it too, of no more than it takes until the edges stop oscillating.
[[nodiscard]] std::vector<PlotSeries> envelope(const PlotSeries& band);
// The edges alone, the upper one with the band's name: of several that lie over one another.
[[nodiscard]] std::vector<PlotSeries> envelope_edges(const PlotSeries& band);

}  // namespace hamgen::app
