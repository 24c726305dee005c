// Looks for events along an orbit: what it was given is called for each, in the order of time.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/event.hpp"

namespace hamgen::runtime {

// A state of the orbit: that after so many steps and one of length `fraction` times h.
struct EventPoint {
  long long steps = 0;      // whole ones before it
  double fraction = 0.0;    // in (0, 1]
  double time = 0.0;        // (steps + fraction) * h
  std::vector<Wide> state;  // 2n values: q then p
};

// A quantity whose zeros are looked for.
struct ObservedEvent {
  EventLocator::Quantity quantity;                  // of the state
  Direction direction = Direction::both;            // which zeros count
  std::function<bool(const EventPoint&)> on_event;  // true ends the run there
};

// Calls each event's function where it happens, to rounding and to the order of the steps.
class EventObserver {
 public:
  // `start`: parameters and h of the run.
  EventObserver(const std::shared_ptr<const Library>& library, const InitialValues& start,
                std::vector<ObservedEvent> events);

  // For IntegrateOptions::on_look, from the first step on.
  [[nodiscard]] long long look(const Integrator& integrator);
  // Where an event ended the run.
  [[nodiscard]] const std::optional<EventPoint>& end() const { return end_; }

 private:
  InitialValues start_;
  std::vector<ObservedEvent> events_;
  std::vector<EventLocator> locators_;
  std::vector<Wide> before_;  // the state a step ago, and the quantities there
  std::vector<double> values_;
  std::optional<EventPoint> end_;
};

}  // namespace hamgen::runtime
