// What ends a study early.
#pragma once

#include <atomic>

namespace hamgen::app {

// Set by Ctrl-C, say; null where nothing stops it.  A study that is stopped returns what it has.
using StopFlag = const std::atomic<bool>*;

[[nodiscard]] inline bool is_stopped(StopFlag stop) { return stop != nullptr && *stop; }

}  // namespace hamgen::app
