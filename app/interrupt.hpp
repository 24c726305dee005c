// Ctrl-C, a closed terminal or a polite kill ends a run in good order.
#pragma once

#include <atomic>

namespace hamgen::app {

// From the first call on, SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGXCPU set the flag; a second
// SIGINT or SIGQUIT ends the program.
[[nodiscard]] const std::atomic<bool>& interrupt_flag();

// A file that reaches the limit of its size (ulimit -f) is an error of writing, not a signal.
void report_full_files();

}  // namespace hamgen::app
