#include "app/studies/section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/studies/angles.hpp"
#include "app/studies/section_starts.hpp"

namespace hamgen::app {
namespace {

constexpr long kStepsOfAProgress = 4096;

runtime::Status status_after_a_step(runtime::Integrator& integrator, double& largest_error) {
  const runtime::Judge& judge = integrator.judge();
  const runtime::Report report = integrator.advance(1, true);
  if (report.status != runtime::Status::done || !report.energy) return report.status;
  largest_error =
      std::max(largest_error, std::abs(runtime::difference(report.energy->last, judge.energy())));
  return judge.is_jump(largest_error)
             ? judge.failure(runtime::Status::jumped, integrator.rounded_state(), largest_error)
             : runtime::Status::done;
}

// Of steps that go back in time what rises with time falls.
runtime::Direction along_steps(runtime::Direction direction, double h) {
  if (h > 0.0 || direction == runtime::Direction::both) return direction;
  return direction == runtime::Direction::rising ? runtime::Direction::falling
                                                 : runtime::Direction::rising;
}

// The multiple of a turn that lies between two values, or that is nearest to them.
double whole_turns_between(double before, double after) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double last = kTurn * std::floor(std::max(before, after) / kTurn);
  return last >= std::min(before, after) ? last : kTurn * std::round(before / kTurn);
}

SectionOrbit follow(const SectionRequest& request, const std::vector<runtime::Wide>& state) {
  runtime::InitialValues start = request.start;
  start.state = state;
  runtime::Integrator integrator(request.library, start);
  const auto axes = [&](std::span<const runtime::Wide> at) {
    return request.library->invariants(start.parameters, at);
  };
  double turns = 0.0;  // that the surface is away
  const runtime::EventLocator locator(
      request.library, start, [&](auto at) { return axes(at)[0].hi - turns; },
      along_steps(request.direction, start.h.hi));
  const auto first = [&](double x) { return request.first_turns ? within_a_turn(x) : x; };
  const auto second = [&](double y) { return request.second_turns ? within_a_turn(y) : y; };
  const auto begin = axes(state);
  SectionOrbit orbit{.energy_scale = integrator.judge().energy_terms()};
  orbit.first = first(begin[1].hi);
  orbit.second = second(begin[2].hi);
  std::vector<runtime::Wide> before = state;
  double value_before = begin[0].hi;
  while (orbit.steps < request.steps && static_cast<long>(orbit.points.size()) < request.points) {
    if (orbit.steps % kStepsOfAProgress == 0 && is_stopped(request.stop)) {
      orbit.status = runtime::Status::stopped;
      break;
    }
    orbit.status = status_after_a_step(integrator, orbit.largest_error);
    if (orbit.status != runtime::Status::done) break;
    ++orbit.steps;
    std::vector<runtime::Wide> after = integrator.state();
    const double value_after = axes(after)[0].hi;
    if (request.turns) turns = whole_turns_between(value_before, value_after);
    for (const runtime::Crossing& crossing :
         locator.within(before, value_before - turns, after, value_after - turns)) {
      if (static_cast<long>(orbit.points.size()) == request.points) break;
      const auto values = axes(crossing.state);
      const double steps = static_cast<double>(orbit.steps - 1) + crossing.fraction;
      orbit.points.push_back({steps * start.h.hi, first(values[1].hi), second(values[2].hi)});
    }
    before = std::move(after);
    value_before = value_after;
  }
  return orbit;
}

}  // namespace

Section section(const SectionRequest& request) {
  const SectionStarts starts = section_starts(request);
  Section result{.orbits = {}, .tried = starts.tried, .unreachable = starts.unreachable};
  const int count = static_cast<int>(starts.states.size());
  for (int i = 0; i < count && !is_stopped(request.stop); ++i) {
    if (request.on_progress) request.on_progress(i, count);
    result.orbits.push_back(follow(request, starts.states[static_cast<std::size_t>(i)]));
  }
  if (request.on_progress) request.on_progress(count, count);
  return result;
}

}  // namespace hamgen::app
