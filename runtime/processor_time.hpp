// Processor time: what is measured and limited must not depend on what else the machine does.
#pragma once

namespace hamgen::runtime {

// Of the calling thread [s].
[[nodiscard]] double thread_seconds();

}  // namespace hamgen::runtime
