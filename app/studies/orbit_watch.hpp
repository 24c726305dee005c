// What is looked for along a run: where it crosses something, when it ends, where it is at times
// between its steps.  The run itself is not changed by it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "generator/language/end_condition.hpp"
#include "generator/language/scene.hpp"
#include "generator/pipeline.hpp"
#include "runtime/event.hpp"

namespace hamgen::app {

struct WatchedEvent {
  EndCondition what;
  bool ends_run = false;
  std::string formula;    // the name of its value among what the plugin computes
  std::size_t place = 0;  // of that value
};

[[nodiscard]] runtime::Direction direction_of(const ModelEvent& event);
// Makes the scene compute the event's value, under a name that neither model nor scene has.
[[nodiscard]] WatchedEvent watch(const EndCondition& what, bool ends_run, const Model& model,
                                 SceneValues& scene);
// Once there is a plugin.
void find_places(std::vector<WatchedEvent>& events, const PluginSource& plugin);
// Is this one of the values that the run computes for itself?
[[nodiscard]] bool is_watched(const SceneValues& scene, const std::string& name);

// A state of the orbit: that after so many steps and one of length `fraction` times h.
struct WatchedPoint {
  long long steps = 0;
  double fraction = 0.0;  // in [0, 1)
  double time = 0.0;
  std::vector<runtime::Wide> state;  // of the step: 2n values
};

// Times that rows are wanted at, in units of h and ascending: a list, or all multiples of one.
struct RowTimes {
  std::vector<Rational> at = {};
  std::optional<Rational> every = {};

  [[nodiscard]] bool empty() const { return at.empty() && !every; }
  // The i-th of them; empty behind the last.
  [[nodiscard]] std::optional<Rational> position(std::size_t i) const;
};

// How often an event was met, when, and the values it had at the ends of steps.
struct Sighting {
  long long count = 0;
  double first = 0.0, last = 0.0;  // times
  double least = 0.0, largest = 0.0;
};

struct OrbitWatchRequest {
  std::shared_ptr<const runtime::Library> library;
  runtime::InitialValues start;
  Rational h;
  std::vector<WatchedEvent> events;
  RowTimes times;
  std::function<void(const WatchedPoint&)> on_row = {};
  std::function<void(std::size_t event, const WatchedPoint&)> on_event = {};
};

class OrbitWatch {
 public:
  explicit OrbitWatch(OrbitWatchRequest request);

  // For runtime::IntegrateOptions::on_look: looks at the step that ends here, or remembers where
  // the next one begins.
  [[nodiscard]] long long look(const runtime::Integrator& integrator);

  // What ended the run, and where; empty if nothing did.
  [[nodiscard]] const std::optional<std::pair<std::size_t, WatchedPoint>>& ending() const {
    return ending_;
  }
  [[nodiscard]] const std::vector<Sighting>& sightings() const { return sightings_; }
  [[nodiscard]] long long rows_missed() const { return rows_missed_; }

 private:
  struct Place {
    long long steps = -1;
    std::vector<runtime::Wide> state;
    std::vector<double> values;  // of the events
  };
  [[nodiscard]] Place place(const runtime::Integrator& integrator) const;
  [[nodiscard]] double time(long long steps, double fraction) const;
  void see_values(const Place& now);
  void see_step(const Place& now);
  void see_start(const Place& now);
  void put_rows(const Place& now, double end);
  [[nodiscard]] long long distance(long long steps) const;

  OrbitWatchRequest request_;
  std::vector<runtime::EventLocator> locators_;  // one an event, unused of those that hold
  std::vector<Sighting> sightings_;
  bool needs_energy_ = false;
  Place before_;
  std::size_t next_row_ = 0;
  long long rows_missed_ = 0;
  std::optional<std::pair<std::size_t, WatchedPoint>> ending_;
};

}  // namespace hamgen::app
