// A stress map as text, CSV, JSON and a picture.
#pragma once

#include <string>

#include "app/studies/stress.hpp"

namespace hamgen::app {

// A map in characters for the terminal, with its legend and the counts of outcomes.
[[nodiscard]] std::string stress_text(const StressMap& map);
[[nodiscard]] std::string stress_csv(const StressMap& map);
[[nodiscard]] std::string stress_json(const StressMap& map);
// A gnuplot script: the plane of the axes with a coloured box a cell, and the linear bound over it.
[[nodiscard]] std::string stress_script(const StressMap& map, const std::string& output);

}  // namespace hamgen::app
