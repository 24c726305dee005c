// What a run says of itself: a summary to read, and the same as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/studies/certify.hpp"
#include "app/studies/orbit_watch.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"
#include "runtime/integrator.hpp"
#include "runtime/trajectory.hpp"

namespace hamgen::app {

struct RunReport {
  std::string path;  // of the model, as typed
  const PluginSource* plugin = nullptr;
  const SceneValues* scene = nullptr;
  const runtime::InitialValues* start = nullptr;
  runtime::RunSummary summary;
  std::vector<runtime::Wide> state;  // the last good one: q then p
  std::vector<runtime::Wide> initial_invariants;
  std::vector<runtime::Wide> final_invariants;
  int scalar_digits = 53;  // binary, of the scalar
  bool from_cache = false;
  std::string optimisation;  // what the compiler was asked for, as "-O3"
  bool interpreted = false;  // there was no compiler
  double generate_seconds = 0.0;
  double compile_seconds = 0.0;
  std::optional<Certificate> certificate;             // if it was asked for
  const std::vector<WatchedEvent>* events = nullptr;  // what was looked for, and what was seen
  const OrbitWatch* watch = nullptr;
  std::optional<double> seconds;  // it had
  std::string trajectory;         // where it is and how many rows; empty if there is none
  std::string header;             // where the emitted header is, or the command that prints it
};

[[nodiscard]] std::string summary_text(const RunReport& report);
[[nodiscard]] std::string json_text(const RunReport& report);
// What went wrong, and where; empty if all steps were done.
[[nodiscard]] std::string failure_text(const RunReport& report);
// Where nothing that was to end the run came to pass: a sentence each.
[[nodiscard]] std::vector<std::string> missed_ends(const RunReport& report);
// The status before it: "status jumped: step 97 jumped: ...", the last line of a trajectory.
[[nodiscard]] std::string outcome_text(const RunReport& report);

}  // namespace hamgen::app
