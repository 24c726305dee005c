// Ctrl-C ends a run in good order.
#pragma once

#include <atomic>

namespace hamgen::app {

// From the first call on, the first SIGINT or SIGTERM sets the flag; a second one ends the program.
[[nodiscard]] const std::atomic<bool>& interrupt_flag();

}  // namespace hamgen::app
