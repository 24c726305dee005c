// The orbit of a report: its pictures in phase space.
#pragma once

#include <vector>

#include "app/output/report_figures.hpp"

namespace hamgen::app {

// One degree of freedom: the scene's orbit among those that start nearer to the origin.  Two and
// three, and bodies in a plane or in space: the planes of the coordinates.  Else the coordinates
// over time.  A time of the model's own is none of them.
[[nodiscard]] std::vector<Figure> orbit_figures(const BenchMethod& method,
                                                const SceneValues& scene);

}  // namespace hamgen::app
