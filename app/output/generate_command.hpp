// A request as the command that emits its files.
#pragma once

#include <string>

#include "generator/pipeline.hpp"

namespace hamgen::app {

// The `hamgen generate` command that emits this request's files: paths as typed, a fixed order of
// options, no output directory.
[[nodiscard]] std::string generate_command(const std::string& model, const Request& request);

}  // namespace hamgen::app
