// How the options of hamgen ensemble are read.
#pragma once

#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "app/studies/ensemble_plan.hpp"

namespace hamgen::app {

struct EnsembleOptions {
  MethodOptions method;
  SceneOptions scene;
  std::vector<std::string> over, random;
  std::string from, draws, seed;
  std::string statistics, every;
  std::string threads, output;
  CompilerChoice compiler;
  bool resume = false;
  bool json = false;
  bool quiet = false;
};

void add_ensemble_options(CLI::App& parser, EnsembleOptions& options);

// Throws UsageError, also for more trajectories than there can be; ToolError.
[[nodiscard]] EnsemblePlan read_plan(const EnsembleOptions& options, const Model& model);

// What the scene observes and the statistics besides, as one list for the scene, and the names of
// the statistics.  Throws UsageError.
struct ObservedAndStatistics {
  std::string observe;
  std::vector<std::string> statistics;
};
[[nodiscard]] ObservedAndStatistics read_statistics(const std::string& statistics,
                                                    const Model& model, SceneRequest scene);

// Within what this hamgen has.
[[nodiscard]] int read_threads(const EnsembleOptions& options);

}  // namespace hamgen::app
