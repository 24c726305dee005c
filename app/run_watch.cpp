#include "app/run_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/output/event_file.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/base/pieces.hpp"

namespace hamgen::app {

void check_watch(const WatchOptions& options, const std::string& output, bool draws,
                 bool has_every) {
  const bool has_times = !options.at.empty() || !options.every_time.empty();
  if (has_times && output.empty() && !draws)
    throw UsageError(
        "--at and --every-time say when rows are made\nhelp: add -o FILE.csv, or -o -");
  if (has_times && has_every)
    throw UsageError(
        "--every counts steps, --at and --every-time are times: leave one of them out");
  if (!options.events.empty()) require_event_file_name(options.events);
  if (!output.empty() && options.events == output)
    throw UsageError(fmt::format("--events and -o both write {}", output));
}

std::vector<WatchedEvent> watched_events(const WatchOptions& options, const Model& model,
                                         SceneValues& scene) {
  std::vector<WatchedEvent> events;
  if (!options.events.empty()) {
    if (model.events.empty())
      throw UsageError(fmt::format("--events {}: {}", options.events, no_event_text(model)));
    for (const ModelEvent& each : model.events)
      events.push_back(watch({.event = each}, false, model, scene));
  }
  for (const std::string& text : listed("--until", options.until))
    events.push_back(watch(read_end_condition(model, "--until", text), true, model, scene));
  return events;
}

namespace {

constexpr long kMostRowTimes = 10'000'000;

Rational position_of(const std::string& option, const Rational& time, const SceneValues& scene) {
  const Rational position = time / *scene.h;
  if (position >= 0 && position <= Rational(*scene.steps)) return position;
  throw UsageError(fmt::format("{}: the run goes from 0 to {:.10g} after its start{}", option,
                               to_double(*scene.h * Rational(*scene.steps)),
                               position < 0 ? "" : "\nhelp: more steps, --steps N"));
}

}  // namespace

RowTimes row_times(const WatchOptions& options, const SceneValues& scene) {
  RowTimes times;
  if (!options.at.empty() && !options.every_time.empty())
    throw UsageError("--at and --every-time both say when: leave one of them out");
  if (!options.every_time.empty()) {
    const Rational distance = constant_option("--every-time", options.every_time);
    const Rational position = abs(Rational(distance / *scene.h));
    if (distance <= 0)
      throw UsageError(
          fmt::format("--every-time {}: a time beyond 0 is wanted", options.every_time));
    if (position * kMostRowTimes < Rational(*scene.steps))
      throw UsageError(fmt::format(
          "--every-time {}: more than {} rows\nhelp: a longer time; every step is --every 1",
          options.every_time, kMostRowTimes));
    times.every = position;
  }
  if (options.at.empty()) return times;
  for (const std::string_view piece : outermost_pieces(options.at)) {
    const std::string text(without_blanks(piece));
    times.at.push_back(position_of("--at " + text, constant_option("--at", text), scene));
  }
  std::ranges::sort(times.at);
  return times;
}

std::optional<double> seconds_of(const WatchOptions& options) {
  if (options.seconds.empty()) return {};
  const Rational seconds = constant_option("--seconds", options.seconds);
  if (seconds <= 0)
    throw UsageError(fmt::format("--seconds {}: a time beyond 0 is wanted", options.seconds));
  return to_double(seconds);
}

bool failed_in_a_step(runtime::Status status) {
  using enum runtime::Status;
  return status != done && status != stopped && status != out_of_time;
}

void require_energy(const std::vector<WatchedEvent>& events, bool watches_energy) {
  for (const WatchedEvent& each : events) {
    if (each.what.energy_error == 0 || watches_energy) continue;
    throw UsageError(
        fmt::format("--until {}: H is not computed in this run\nhelp: observe it, "
                    "--observe energy, or leave nothing out, --whole",
                    each.what.event.text));
  }
}

runtime::Record record_of(const WatchedPoint& point, const runtime::Library& library,
                          const runtime::InitialValues& start,
                          const std::vector<runtime::Wide>& invariants) {
  return {.step = point.steps,
          .time = point.time,
          .state = point.state,
          .energy = library.energy(start.parameters, point.state),
          .invariants = invariants};
}

}  // namespace hamgen::app
