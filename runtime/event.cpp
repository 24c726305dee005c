#include "runtime/event.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "runtime/bracketed_root.hpp"

namespace hamgen::runtime {
namespace {

// Where the cubic is looked at: close to both ends too, for a turn next to them.
constexpr std::array<double, 9> kLooks = {0.03125, 0.125, 0.25,  0.375,  0.5,
                                          0.625,   0.75,  0.875, 0.96875};

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
    const double r = 1.0 - s;
    std::vector<Wide> state(before_.size());
    for (std::size_t i = 0; i < state.size(); ++i) {
      state[i].hi = (1.0 + 2.0 * s) * r * r * before_[i].hi + s * r * r * h_ * slope_before_[i] +
                    s * s * (1.0 + 2.0 * r) * after_[i].hi - s * s * r * h_ * slope_after_[i];
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

bool same_sign(double a, double b) { return (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0); }

// Where |f| is smallest between a and b, about: golden section.
template <typename Function>
double smallest_between(const Function& f, double a, double b) {
  constexpr double kGolden = 0.6180339887498949;
  double left = b - kGolden * (b - a);
  double right = a + kGolden * (b - a);
  double at_left = f(left);
  double at_right = f(right);
  for (int i = 0; i < 24; ++i) {
    if (at_left < at_right) {
      b = std::exchange(right, left);
      at_right = at_left;
      at_left = f(left = b - kGolden * (b - a));
    } else {
      a = std::exchange(left, right);
      at_left = at_right;
      at_right = f(right = a + kGolden * (b - a));
    }
  }
  return 0.5 * (a + b);
}

}  // namespace

std::optional<std::vector<Wide>> part_of_step(const std::shared_ptr<const Library>& library,
                                              const InitialValues& start,
                                              const std::vector<Wide>& from, const Wide& theta) {
  if (theta.hi == 0.0) return from;
  InitialValues part = start;
  part.h = product(start.h, theta);
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

bool EventLocator::counts(double before, double after) const {
  const bool rises = before < 0.0 && after >= 0.0;
  const bool falls = before > 0.0 && after <= 0.0;
  return (rises && direction_ != Direction::falling) || (falls && direction_ != Direction::rising);
}

// Fractions inside the step where the sign may be another than at both ends.
std::vector<double> EventLocator::suspected(const std::vector<Wide>& before, double value_before,
                                            const std::vector<Wide>& after,
                                            double value_after) const {
  const Cubic cubic(*library_, start_, before, after);
  const auto look = [&](double s) { return quantity_(cubic.at(s)); };
  std::vector<Sample> samples = {{0.0, value_before}, {0.5, look(0.5)}, {1.0, value_after}};
  // Far from zero beside how it changes: nothing to be seen between.
  const auto [low, high] = std::ranges::minmax(samples, {}, &Sample::value);
  if (low.value > 2.0 * (high.value - low.value) || -high.value > 2.0 * (high.value - low.value))
    return {};
  samples = {{0.0, value_before}};
  for (const double s : kLooks) samples.push_back({s, look(s)});
  samples.push_back({1.0, value_after});
  std::vector<double> result;
  double largest = 0.0;
  for (const Sample& each : samples) largest = std::max(largest, std::abs(each.value));
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const auto& [s, value] = samples[i];
    if (!same_sign(value, samples[i - 1].value) || !same_sign(value, samples[i + 1].value)) {
      result.push_back(s);
      continue;
    }
    const bool turns = std::abs(value) <= std::abs(samples[i - 1].value) &&
                       std::abs(value) <= std::abs(samples[i + 1].value);
    if (!turns) continue;
    const double sign = value > 0.0 ? 1.0 : -1.0;
    const double at = smallest_between([&](double x) { return sign * look(x); },
                                       samples[i - 1].theta, samples[i + 1].theta);
    if (sign * look(at) < 0.05 * largest) result.push_back(at);
  }
  return result;
}

std::optional<Crossing> EventLocator::root(const std::vector<Wide>& from, const Sample& low,
                                           const Sample& high,
                                           const std::vector<Wide>& after) const {
  if (high.value == 0.0 && high.theta == 1.0) return Crossing{1.0, after};
  bool failed = false;
  const auto quantity = [&](double theta) {
    if (theta == low.theta) return low.value;
    if (theta == high.theta) return high.value;
    const auto value = value_after_part(from, theta);
    failed = failed || !value;
    return value.value_or(high.value);
  };
  const double theta = bracketed_root(quantity, low.theta, low.value, high.theta, high.value);
  auto state =
      theta >= 1.0 ? std::optional(after) : part_of_step(library_, start_, from, {theta, 0.0});
  if (failed || !state) return std::nullopt;
  return Crossing{theta, std::move(*state)};
}

std::vector<Crossing> EventLocator::within(const std::vector<Wide>& before, double value_before,
                                           const std::vector<Wide>& after,
                                           double value_after) const {
  if (!std::isfinite(value_before) || !std::isfinite(value_after)) return {};
  std::vector<Sample> samples = {{0.0, value_before}};
  for (const double theta : suspected(before, value_before, after, value_after)) {
    if (const auto value = value_after_part(before, theta)) samples.push_back({theta, *value});
  }
  samples.push_back({1.0, value_after});
  std::vector<Crossing> crossings;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (!counts(samples[i - 1].value, samples[i].value)) continue;
    if (auto crossing = root(before, samples[i - 1], samples[i], after))
      crossings.push_back(std::move(*crossing));
  }
  return crossings;
}

}  // namespace hamgen::runtime
