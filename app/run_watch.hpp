// What `run` looks for along its orbit, from its options.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "app/studies/orbit_watch.hpp"
#include "runtime/trajectory.hpp"

namespace hamgen::app {

struct WatchOptions {
  std::vector<std::string> until;
  std::string seconds;
  std::string at, every_time;  // times of rows
  std::string events;          // the file of the model's events
};

// Makes the scene compute what is looked for.
[[nodiscard]] std::vector<WatchedEvent> watched_events(const WatchOptions& options,
                                                       const Model& model, SceneValues& scene);
// In units of h.  Throws UsageError for a time before the start or behind the last step.
[[nodiscard]] RowTimes row_times(const WatchOptions& options, const SceneValues& scene);
[[nodiscard]] std::optional<double> seconds_of(const WatchOptions& options);
// Throws UsageError where one needs H and it is not computed.
void require_energy(const std::vector<WatchedEvent>& events, bool watches_energy);
// What a row says of a point of the orbit.  The record refers to the point and its invariants.
[[nodiscard]] runtime::Record record_of(const WatchedPoint& point, const runtime::Library& library,
                                        const runtime::InitialValues& start,
                                        const std::vector<runtime::Wide>& invariants);

}  // namespace hamgen::app
