#include "app/studies/bench_target.hpp"

#include <algorithm>
#include <cmath>

namespace hamgen::app {
namespace {

constexpr double kClose = 1.03;         // a step this near the best one is good enough
constexpr double kLargestGrowth = 8.0;  // from one sample to the next
constexpr double kLeastSlope = 0.5;     // errors that fall more slowly are round-off
// Costs come from a single run each: only a method that is this much slower is given up.
constexpr double kClearlySlower = 1.5;

double slope(const StepSample& fine, const StepSample& coarse) {
  return std::log(coarse.error / fine.error) / std::log(coarse.h / fine.h);
}

// The power of h by which the error falls below the finest sample; empty at round-off.
std::optional<double> slope_below(const StepSearch& search) {
  std::vector<StepSample> samples = search.samples;
  std::ranges::sort(samples, {}, &StepSample::h);
  if (samples.empty() || !std::isfinite(samples.front().error)) return {};
  if (samples.size() == 1 || !std::isfinite(samples[1].error)) return search.order;
  const double power = slope(samples[0], samples[1]);
  if (!(power >= kLeastSlope)) return {};
  return std::min(power, search.order);
}

// Half way, in log h, of what counts as close: the error there for a method of this order.
double aim(const StepSearch& search) { return search.target * std::pow(kClose, -search.order / 2); }

std::optional<double> step_below(const StepSearch& search) {
  const std::optional<double> power = slope_below(search);
  if (!power) return {};
  const StepSample& fine = *search.smallest();
  return fine.h * std::pow(aim(search) / fine.error, 1.0 / *power);
}

double step_above(const StepSearch& search) {
  const StepSample& in = *search.inside();
  if (in.error == 0.0) return kLargestGrowth * in.h;
  const double factor = std::pow(aim(search) / in.error, 1.0 / search.order);
  return in.h * std::clamp(factor, kClose, kLargestGrowth);
}

double step_between(const StepSearch& search) {
  constexpr int most_interpolations = 2;  // then bisection: the errors are no power of h
  const StepSample& in = *search.inside();
  const StepSample& out = *search.outside();
  const double width = std::log(out.h / in.h);
  const bool is_power = in.error > 0.0 && std::isfinite(out.error);
  if (!is_power || search.interpolations >= most_interpolations)
    return in.h * std::exp(0.5 * width);
  const double part = std::log(aim(search) / in.error) / std::log(out.error / in.error);
  return in.h * std::exp(std::clamp(part, 0.1, 0.9) * width);
}

}  // namespace

const StepSample* StepSearch::smallest() const {
  const auto least = std::ranges::min_element(samples, {}, &StepSample::h);
  return least == samples.end() ? nullptr : &*least;
}

const StepSample* StepSearch::inside() const {
  const StepSample* best = nullptr;
  for (const StepSample& sample : samples) {
    if (sample.error <= target && (best == nullptr || sample.h > best->h)) best = &sample;
  }
  return best;
}

const StepSample* StepSearch::outside() const {
  const StepSample* const in = inside();
  const StepSample* best = nullptr;
  for (const StepSample& sample : samples) {
    if (in != nullptr && sample.h > in->h && (best == nullptr || sample.h < best->h))
      best = &sample;
  }
  return best;
}

double StepSearch::expected_cost() const {
  if (const StepSample* const in = inside()) {
    return in->cost * in->h / (is_bracket() ? step_between(*this) : step_above(*this));
  }
  const std::optional<double> h = step_below(*this);
  return h ? smallest()->cost * smallest()->h / *h : HUGE_VAL;
}

std::optional<double> next_step(const StepSearch& search) {
  const StepSample* const in = search.inside();
  const double most = kClearlySlower * search.best_cost;
  if (in == nullptr) {
    const std::optional<double> h = step_below(search);
    if (!h || *h < search.finest || search.expected_cost() > most) return {};
    return h;
  }
  // A power of h of at least the order reaches the target before kClose times this step.
  const bool is_close = in->error * std::pow(kClose, search.order) >= search.target;
  const StepSample* const out = search.outside();
  if (out == nullptr) return is_close ? std::nullopt : std::optional(step_above(search));
  // Steps below `out` cost more than it does.
  if (is_close || out->h <= kClose * in->h || out->cost > most) return {};
  return step_between(search);
}

std::vector<double> larger_steps(const StepSearch& search) {
  constexpr int parts_of_octave = 12;
  const StepSample* const in = search.inside();
  std::vector<double> steps;
  for (int part = 2 * parts_of_octave; in != nullptr && part > 0; --part) {
    const double times = std::exp2(static_cast<double>(part) / parts_of_octave);
    if (in->cost / times < search.best_cost / kClose) steps.push_back(in->h * times);
  }
  return steps;
}

}  // namespace hamgen::app
