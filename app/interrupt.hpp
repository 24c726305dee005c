// Ctrl-C, or a polite kill, ends a run in good order.
#pragma once

#include <atomic>

namespace hamgen::app {

// From the first call on, SIGINT and SIGTERM set the flag; a second SIGINT ends the program.
[[nodiscard]] const std::atomic<bool>& interrupt_flag();

}  // namespace hamgen::app
