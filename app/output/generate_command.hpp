// A request as a command: the one that emits its files, and the one that runs it.
#pragma once

#include <string>

#include "generator/pipeline.hpp"

namespace hamgen::app {

// The `hamgen generate` command that emits this request's files: paths as typed, a fixed order of
// options, no output directory.
[[nodiscard]] std::string generate_command(const std::string& model, const Request& request);
// The `hamgen run` command of the method with this step size, and of its scene.
[[nodiscard]] std::string run_command(const std::string& model, const Request& request,
                                      const Rational& h, long steps);

}  // namespace hamgen::app
