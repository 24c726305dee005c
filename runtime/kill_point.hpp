// Places at which a test ends the process as a power cut would.
#pragma once

namespace hamgen::runtime {

// The environment variable HAMGEN_KILL_POINT=N ends the process by SIGKILL the Nth time it comes to
// one of these places: within a write, before and after a rename.  Without it they do nothing.
void kill_point();
// Is it set?  A write is then done in two halves, with such a place in between.
[[nodiscard]] bool has_kill_points();

}  // namespace hamgen::runtime
