// What finds the events of an emitted C++ file along its steps, as it has to be.
#pragma once

#include "generator/readback/shell.hpp"

namespace hamgen {

[[nodiscard]] Pattern watch_pattern(const Watch& watch, const Environment& environment);

}  // namespace hamgen
