// Several threads at a piece of work, where hamgen was built with oneTBB.
#pragma once

#include <functional>

namespace hamgen::app {

// Else there is one thread, whatever is asked for.
[[nodiscard]] bool has_threads();
// As many as the machine has processors for this process; 1 without oneTBB.
[[nodiscard]] int all_threads();

// Calls work() from so many threads at once, this one among them, until each has returned.  The
// first exception passes through once all are back.
void on_threads(int threads, const std::function<void()>& work);

}  // namespace hamgen::app
