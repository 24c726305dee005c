// What finds the events of an emitted C++ file along its steps, as it has to be.
#pragma once

#include "generator/readback/shell.hpp"

namespace hamgen {

[[nodiscard]] Pattern event_pattern(const ShellFacts& facts);
[[nodiscard]] Pattern watched_pattern(const ShellFacts& facts);
// And behind it what is the same in all of them, from the struct Crossing on.
[[nodiscard]] Pattern watched_propagator_pattern();

}  // namespace hamgen
