// How a comparison of methods is asked for: by `hamgen bench`, and by the report that contains one.
#pragma once

#include <string>

#include "app/command_line.hpp"
#include "app/studies/bench_run.hpp"

namespace hamgen::app {

// Texts as on the command line; empty means the default.
struct BenchOptions {
  std::string model;
  SceneOptions scene;  // h and steps are in place of the scene's own
  std::string schemes, h, time, steps, target;
  CompilerChoice compiler;
  std::string observe = "state";
  std::string rounds = "9";
  bool plain_sums = false;
  bool quiet = false;
  const char* length = "--time 10";  // the option for a scene without steps
};

// With progress bars unless quiet; Ctrl-C stops it.  Throws UsageError and ModelError.
[[nodiscard]] BenchRequest read_bench(const BenchOptions& options);

}  // namespace hamgen::app
