// What finds the events of an emitted C++ file along its steps, as it has to be.
#pragma once

#include "generator/readback/shell.hpp"

namespace hamgen {

[[nodiscard]] Pattern event_pattern(const ShellFacts& facts);
[[nodiscard]] Pattern crossing_pattern();
[[nodiscard]] Pattern watched_propagator_pattern(const ShellFacts& facts);

}  // namespace hamgen
