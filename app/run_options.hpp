// What `hamgen run` is asked for.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "app/command_line.hpp"
#include "app/run_checkpoint.hpp"
#include "app/run_watch.hpp"

namespace hamgen::app {

struct RunOptions {
  MethodOptions method;
  CompilerChoice compiler;
  bool interpret = false;
  SceneOptions scene;
  std::string every;
  std::string watch_modified;
  WatchOptions watch;
  std::string output, plot, columns;
  std::string header;
  bool certify = false;
  CheckpointOptions checkpoint;
  bool json = false;
  bool quiet = false;
};

void add_run_options(CLI::App& parser, RunOptions& options);
// Throws UsageError where a file has no name of its kind, or two of them are one.
void require_run_files(const RunOptions& options);
// The distance of records: the option, else the scene's, else 1; the last two unless that makes a
// flood of rows, as a scene's distance may with many more steps than the scene has: a UsageError.
[[nodiscard]] long record_distance(const RunOptions& options, const SceneValues& scene);

}  // namespace hamgen::app
