// The axes of a stress map as they are typed.
#pragma once

#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "app/studies/stress.hpp"

namespace hamgen::app {

// One axis for each "NAME=LOW:HIGH[:COUNT]" of --vary, and h if there are fewer than two and none
// is h.  Throws UsageError.
[[nodiscard]] std::vector<StressAxis> read_axes(const std::vector<std::string>& vary);

// The method with alpha, beta, gamma by their own names, which makes them run-time parameters,
// where an axis varies them and no expression mentions them.  Throws UsageError if both are given.
[[nodiscard]] MethodOptions with_run_time_members(MethodOptions method,
                                                  const std::vector<StressAxis>& axes);

}  // namespace hamgen::app
