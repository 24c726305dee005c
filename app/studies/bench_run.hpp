// The whole measurement of `hamgen bench`, for the commands that show it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "app/output/bench_output.hpp"

namespace hamgen::app {

// Texts as on the command line; empty means the default.
struct BenchRequest {
  std::string model;
  SceneOptions scene;
  std::string schemes, h, time, target, compiler;
  std::string observe = "state";
  std::string rounds = "9";
  bool quiet = false;
  std::optional<std::string> scene_h, scene_steps;  // in place of the scene's
  const char* length = "--time 10";                 // the option for a scene without steps
};

// Loads the methods, computes the reference, measures errors, then times; with progress bars on a
// terminal unless quiet.  After an interrupt it returns early.  Throws UsageError, ModelError and
// ToolError.
[[nodiscard]] Bench run_bench(const BenchRequest& request);

}  // namespace hamgen::app
