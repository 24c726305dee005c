#include "runtime/event.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hamgen::runtime {
namespace {

// What emitted files look for events with.
namespace event_numerics {
using Real = double;
inline Real magnitude(Real x) { return std::abs(x); }
constexpr Real largest = std::numeric_limits<Real>::max();
constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
#include "generator/numerics/bracketed_root.hpp"
#include "generator/numerics/crossings.hpp"
}  // namespace event_numerics

// The cubic through two states and their derivatives, s from 0 to 1.
class Cubic {
 public:
  Cubic(const Library& library, const InitialValues& start, const std::vector<Wide>& before,
        const std::vector<Wide>& after)
      : before_(before), after_(after), h_(start.h.hi) {
    std::vector<double> parameters;
    for (const Wide& value : start.parameters) parameters.push_back(value.hi);
    slope_before_ = derivative(library, parameters, before);
    slope_after_ = derivative(library, parameters, after);
  }

  [[nodiscard]] std::vector<Wide> at(double s) const {
    std::vector<Wide> state(before_.size());
    for (std::size_t i = 0; i < state.size(); ++i) {
      state[i].hi = event_numerics::cubic_between(s, h_, before_[i].hi, slope_before_[i],
                                                  after_[i].hi, slope_after_[i]);
    }
    return state;
  }

 private:
  // J grad H.
  static std::vector<double> derivative(const Library& library,
                                        const std::vector<double>& parameters,
                                        const std::vector<Wide>& state) {
    std::vector<double> rounded;
    for (const Wide& value : state) rounded.push_back(value.hi);
    std::vector<double> result = library.gradient(parameters, rounded);
    const auto half = static_cast<std::ptrdiff_t>(result.size() / 2);
    std::rotate(result.begin(), result.begin() + half, result.end());
    for (auto it = result.begin() + half; it != result.end(); ++it) *it = -*it;
    return result;
  }

  const std::vector<Wide>& before_;
  const std::vector<Wide>& after_;
  double h_;
  std::vector<double> slope_before_, slope_after_;
};

// To 106 bits, less a few.
Wide product(const Wide& a, const Wide& b) {
  const double hi = a.hi * b.hi;
  const double lo = std::fma(a.hi, b.hi, -hi) + (a.hi * b.lo + a.lo * b.hi);
  return {hi + lo, lo - ((hi + lo) - hi)};
}

}  // namespace

InitialValues with_part_of_step(InitialValues start, const Wide& theta) {
  start.h = product(start.h, theta);
  return start;
}

double reach_of_step(const std::shared_ptr<const Library>& library, const InitialValues& start,
                     const std::vector<Wide>& from,
                     const std::function<bool(std::span<const Wide>)>& is_good) {
  const auto reaches = [&](double theta) {
    const auto state = part_of_step(library, start, from, {theta, 0.0});
    return state && is_good(*state);
  };
  double good = 0.5;
  while (good > 1e-6 && !reaches(good)) good *= 0.5;
  if (good <= 1e-6) return 0.0;
  double bad = 2.0 * good;
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (good + bad);
    (reaches(middle) ? good : bad) = middle;
  }
  return good;
}

std::optional<std::vector<Wide>> part_of_step(const std::shared_ptr<const Library>& library,
                                              const InitialValues& start,
                                              const std::vector<Wide>& from, const Wide& theta) {
  if (theta.hi == 0.0) return from;
  InitialValues part = with_part_of_step(start, theta);
  part.state = from;
  Integrator integrator(library, part);
  if (integrator.advance(1, false).status != Status::done) return std::nullopt;
  return integrator.state();
}

EventLocator::EventLocator(std::shared_ptr<const Library> library, InitialValues start,
                           Quantity quantity, Direction direction)
    : library_(std::move(library)),
      start_(std::move(start)),
      quantity_(std::move(quantity)),
      direction_(direction) {}

std::optional<double> EventLocator::value_after_part(const std::vector<Wide>& from,
                                                     double theta) const {
  const auto state = part_of_step(library_, start_, from, {theta, 0.0});
  if (!state) return std::nullopt;
  const double value = quantity_(*state);
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

std::vector<Crossing> EventLocator::within(const std::vector<Wide>& before, double value_before,
                                           const std::vector<Wide>& after,
                                           double value_after) const {
  if (!std::isfinite(value_before) || !std::isfinite(value_after)) return {};
  const Cubic cubic(*library_, start_, before, after);
  const auto value = [&](double theta, double& result) {
    const auto found = value_after_part(before, theta);
    if (found) result = *found;
    return found.has_value();
  };
  const auto look = [&](double s) { return quantity_(cubic.at(s)); };
  std::vector<Crossing> crossings;
  event_numerics::find_crossings(
      value, look, value_before, value_after, direction_ != Direction::falling,
      direction_ != Direction::rising, [&](double theta) {
        auto state = theta >= 1.0 ? std::optional(after)
                                  : part_of_step(library_, start_, before, {theta, 0.0});
        if (state) crossings.push_back({theta, std::move(*state)});
      });
  return crossings;
}

}  // namespace hamgen::runtime
