// Progress of studies on a terminal.
#pragma once

#include "app/studies/progress.hpp"

namespace hamgen::app {

// A bar on standard error for each work in turn, removed at its end; empty if quiet.  Where that is
// no terminal, a line now and then for work that takes long.
[[nodiscard]] ProgressSink progress_bars(bool quiet);

}  // namespace hamgen::app
