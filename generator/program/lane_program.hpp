// The program of trajectories in lanes.
#pragma once

#include "generator/program/program.hpp"

namespace hamgen {

// The same program where a number is one of each lane: flags and counts that differ from lane to
// lane are masks and numbers, and what is solved knows which lanes have a part in it
// (numerics/lane_turn.hpp).  The others keep what a routine would change.
[[nodiscard]] Program in_lanes(Program code);

}  // namespace hamgen
