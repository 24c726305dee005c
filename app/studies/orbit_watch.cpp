#include "app/studies/orbit_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "app/studies/initial_data.hpp"

namespace hamgen::app {
namespace {

constexpr long long kNever = std::numeric_limits<long long>::max();

std::set<std::string> names_of(const Model& model, const SceneValues& scene) {
  std::set<std::string> names = {model.name};
  const auto add = [&names](const auto& all) {
    for (const auto& each : all) names.insert(each.name);
  };
  add(model.sizes);
  add(model.coordinates);
  add(model.momenta);
  add(model.parameters);
  add(model.definitions);
  add(model.invariants);
  add(scene.formulas);
  add(scene.watched);
  return names;
}

// The largest integer below it.
long long below(const Rational& position) {
  mpz_class floor;
  mpz_fdiv_q(floor.get_mpz_t(), position.get_num_mpz_t(), position.get_den_mpz_t());
  return floor.get_si() - (position.get_den() == 1 ? 1 : 0);
}

}  // namespace

runtime::Direction direction_of(const ModelEvent& event) {
  if (event.rising && event.falling) return runtime::Direction::both;
  return event.rising ? runtime::Direction::rising : runtime::Direction::falling;
}

WatchedEvent watch(const EndCondition& what, bool ends_run, const Model& model,
                   SceneValues& scene) {
  const std::set<std::string> taken = names_of(model, scene);
  std::string name = what.event.name.empty() ? "watched" : what.event.name + "_event";
  while (taken.contains(name)) name += '_';
  scene.watched.push_back({name, what.event.value, what.event.text});
  return {.what = what, .ends_run = ends_run, .formula = name};
}

void find_places(std::vector<WatchedEvent>& events, const PluginSource& plugin) {
  for (WatchedEvent& each : events) {
    const auto it = std::ranges::find(plugin.invariant_names, each.formula);
    if (it == plugin.invariant_names.end()) internal_error("a watched value is not computed");
    each.place = static_cast<std::size_t>(it - plugin.invariant_names.begin());
  }
}

bool is_watched(const SceneValues& scene, const std::string& name) {
  return std::ranges::find(scene.watched, name, &ObservedFormula::name) != scene.watched.end();
}

std::optional<Rational> RowTimes::position(std::size_t i) const {
  if (every) return *every * Rational(static_cast<unsigned long>(i));
  return i < at.size() ? std::optional(at[i]) : std::nullopt;
}

OrbitWatch::OrbitWatch(OrbitWatchRequest request)
    : request_(std::move(request)), sightings_(request_.events.size()) {
  for (const WatchedEvent& each : request_.events) {
    needs_energy_ = needs_energy_ || each.what.energy_error != 0;
    const auto value = [library = request_.library, parameters = request_.start.parameters,
                        place = each.place](std::span<const runtime::Wide> state) {
      return library->invariants(parameters, state)[place].hi;
    };
    locators_.emplace_back(request_.library, request_.start, value, direction_of(each.what.event));
  }
}

double OrbitWatch::time(long long steps, double fraction) const {
  const auto count = static_cast<double>(steps);
  const runtime::Wide& h = request_.start.h;
  return std::fma(count, h.hi, count * h.lo) + fraction * h.hi;
}

OrbitWatch::Place OrbitWatch::place(const runtime::Integrator& integrator) const {
  Place now{.steps = integrator.steps_done(), .state = integrator.state(), .values = {}};
  if (request_.events.empty()) return now;
  const std::vector<runtime::Wide> values =
      request_.library->invariants(request_.start.parameters, now.state);
  const double error =
      needs_energy_
          ? std::abs(runtime::difference(integrator.energy(), integrator.judge().energy()))
          : 0.0;
  for (const WatchedEvent& each : request_.events)
    now.values.push_back(values[each.place].hi + each.what.energy_error * error);
  return now;
}

void OrbitWatch::see_values(const Place& now) {
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    Sighting& seen = sightings_[i];
    const double value = now.values[i];
    seen.least = now.steps == 0 ? value : std::min(seen.least, value);
    seen.largest = now.steps == 0 ? value : std::max(seen.largest, value);
    const WatchedEvent& event = request_.events[i];
    if (!event.what.holds || !(value > 0.0) || ending_) continue;
    ++seen.count;
    ending_ = {
        i, {.steps = now.steps, .fraction = 0.0, .time = time(now.steps, 0.0), .state = now.state}};
  }
}

void OrbitWatch::put_rows(const Place& now, double end) {
  const Rational begin(static_cast<long>(before_.steps));
  while (const std::optional<Rational> position = request_.times.position(next_row_)) {
    const Rational theta = *position - begin;
    const double fraction = to_double(theta);
    if (fraction > end) return;
    ++next_row_;
    const auto state = fraction >= 1.0 ? std::optional(now.state)
                                       : runtime::part_of_step(request_.library, request_.start,
                                                               before_.state, wide(theta));
    if (state && request_.on_row)
      request_.on_row({.steps = before_.steps + (fraction >= 1.0 ? 1 : 0),
                       .fraction = fraction >= 1.0 ? 0.0 : fraction,
                       .time = to_double(*position * request_.h),
                       .state = *state});
    if (!state) ++rows_missed_;
  }
}

void OrbitWatch::see_start(const Place& now) {
  see_values(now);
  before_ = now;
  put_rows(now, 0.0);
}

void OrbitWatch::see_step(const Place& now) {
  struct Seen {
    std::size_t event;
    runtime::Crossing crossing;
  };
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < request_.events.size(); ++i) {
    if (request_.events[i].what.holds) continue;
    for (runtime::Crossing& each :
         locators_[i].within(before_.state, before_.values[i], now.state, now.values[i]))
      seen.push_back({i, std::move(each)});
  }
  std::ranges::stable_sort(seen, {}, [](const Seen& each) { return each.crossing.fraction; });
  double end = 1.0;
  for (Seen& each : seen) {
    const double fraction = each.crossing.fraction;
    const bool at_end = fraction >= 1.0;
    WatchedPoint point{.steps = at_end ? now.steps : before_.steps,
                       .fraction = at_end ? 0.0 : fraction,
                       .time = time(before_.steps, fraction),
                       .state = std::move(each.crossing.state)};
    Sighting& sighting = sightings_[each.event];
    if (sighting.count++ == 0) sighting.first = point.time;
    sighting.last = point.time;
    if (request_.on_event) request_.on_event(each.event, point);
    if (!request_.events[each.event].ends_run) continue;
    ending_ = {each.event, std::move(point)};
    end = fraction;
    break;
  }
  see_values(now);
  put_rows(now, end);
}

long long OrbitWatch::distance(long long steps) const {
  if (ending_) return 0;
  if (!request_.events.empty()) return 1;
  const std::optional<Rational> next = request_.times.position(next_row_);
  return next ? std::max(1LL, below(*next) - steps) : kNever;
}

long long OrbitWatch::look(const runtime::Integrator& integrator) {
  Place now = place(integrator);
  if (now.steps == 0) {
    see_start(now);
  } else if (before_.steps + 1 == now.steps) {
    see_step(now);
  }
  before_ = std::move(now);
  return distance(before_.steps);
}

}  // namespace hamgen::app
