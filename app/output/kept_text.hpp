// How well an energy was kept, for the screen.
#pragma once

#include <string>

namespace hamgen::app {

// "1.2e-09 of its scale 0.083"; the error as it is where there is no scale (Judge::energy_terms).
[[nodiscard]] std::string kept_text(double error, double scale);

}  // namespace hamgen::app
