#include "runtime/event_observer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hamgen::runtime {

EventObserver::EventObserver(const std::shared_ptr<const Library>& library,
                             const InitialValues& start, std::vector<ObservedEvent> events)
    : start_(start), events_(std::move(events)) {
  for (const ObservedEvent& each : events_)
    locators_.emplace_back(library, start, each.quantity, each.direction);
}

long long EventObserver::look(const Integrator& integrator) {
  constexpr long long kNoMore = std::numeric_limits<long long>::max();
  if (events_.empty()) return kNoMore;
  std::vector<Wide> state = integrator.state();
  std::vector<double> values;
  for (const EventLocator& each : locators_) values.push_back(each.value(state));
  std::vector<std::pair<std::size_t, Crossing>> seen;
  for (std::size_t i = 0; i < locators_.size() && !before_.empty(); ++i) {
    for (Crossing& each : locators_[i].within(before_, values_[i], state, values[i]))
      seen.emplace_back(i, std::move(each));
  }
  std::ranges::stable_sort(seen, {}, [](const auto& each) { return each.second.fraction; });
  for (auto& [event, crossing] : seen) {
    const long long steps = integrator.steps_done() - 1;
    const double count = static_cast<double>(steps) + crossing.fraction;
    EventPoint point{.steps = steps,
                     .fraction = crossing.fraction,
                     .time = std::fma(count, start_.h.hi, count * start_.h.lo),
                     .state = std::move(crossing.state)};
    if (!events_[event].on_event || !events_[event].on_event(point)) continue;
    end_ = std::move(point);
    return 0;
  }
  before_ = std::move(state);
  values_ = std::move(values);
  return 1;
}

}  // namespace hamgen::runtime
