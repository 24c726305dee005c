// The whole measurement of `hamgen bench`, for the commands that show it.
#pragma once

#include <string>
#include <vector>

#include "app/studies/bench.hpp"
#include "app/studies/load_integrator.hpp"
#include "app/studies/progress.hpp"
#include "app/studies/setting.hpp"
#include "app/studies/stop.hpp"

namespace hamgen::app {

struct BenchSpec {
  std::string spec;  // as typed
  Request request;
  bool is_offered = false;   // not asked for by name: left out where the model has none such
  bool is_baseline = false;  // no answer
};

struct BenchRequest {
  Setting setting;
  SceneValues scene;
  std::vector<BenchSpec> methods;
  Rational time;                // of each run
  std::vector<Rational> steps;  // their sizes, changed a little where they do not divide the time;
                                // none: for each method those around the scene's h that matter
  Observed observed = Observed::state;
  std::vector<double> targets;  // errors to reach
  bool refines = false;         // further steps are tried to reach them soonest
  long rounds = 9;              // samples of each time
  CompilerChoice compiler;
  RunClock clock = processor_clock;  // what is chosen by time is chosen by this one
  StopFlag stop = nullptr;
  ProgressSink on_progress;
};

// Loads the methods, computes the reference where states count, measures errors, then times.  What
// answers a target has run for ten times as long.  Without a reference the errors of the energy are
// those that count.  Stopped, it returns early with the rows that are measured.  Throws UsageError,
// ModelError and ToolError.
[[nodiscard]] Bench run_bench(const BenchRequest& request);

}  // namespace hamgen::app
