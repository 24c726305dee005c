#include "app/studies/natural_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace hamgen::app {
namespace {

constexpr int kLargestExponent = 1000;
constexpr double kPart = 0.25;  // an attraction that ends far away is never all of the scale
constexpr int kNearOne = 6;     // exponents of sizes that are 1 in the model's own units

class ChangeOfEnergy {
 public:
  ChangeOfEnergy(const runtime::Library& library, const runtime::InitialValues& start)
      : library_(library), start_(start), state_(start.state), here_(energy()) {}

  // |H - H(start)| with this component changed; the larger of both directions, and infinite where H
  // has no value.
  double by(std::size_t component, double change) {
    return std::max(one_way(component, change), one_way(component, -change));
  }

 private:
  [[nodiscard]] double energy() const { return library_.energy(start_.parameters, state_).hi; }

  double one_way(std::size_t component, double change) {
    const runtime::Wide before = state_[component];
    state_[component] = {before.hi + change, 0.0};
    const double difference = std::abs(energy() - here_);
    state_[component] = before;
    return std::isfinite(difference) ? difference : std::numeric_limits<double>::infinity();
  }

  const runtime::Library& library_;
  const runtime::InitialValues& start_;
  std::vector<runtime::Wide> state_;
  double here_;
};

std::optional<double> size_of(ChangeOfEnergy& change, std::size_t component, double scale) {
  const auto reaches = [&](int exponent) {
    return change.by(component, std::ldexp(1.0, exponent)) >= kPart * scale;
  };
  // One by one at first, for H may be periodic; where it grows leaps find the same.
  constexpr int kNear = 8;
  constexpr int kLeap = 16;
  int exponent = 0;
  while (exponent < kLargestExponent && !reaches(exponent))
    exponent += exponent < kNear ? 1 : kLeap;
  if (exponent >= kLargestExponent) return std::nullopt;
  while (exponent > -kLargestExponent && reaches(exponent - 1)) --exponent;
  if (std::abs(exponent) <= kNearOne) return 1.0;
  return std::ldexp(1.0, exponent);
}

}  // namespace

std::vector<double> natural_sizes(const runtime::Library& library,
                                  const runtime::InitialValues& start, double energy) {
  std::vector<double> sizes(start.state.size(), 1.0);
  if (!(energy > 0.0) || !std::isfinite(energy)) return sizes;
  ChangeOfEnergy change(library, start);
  const std::size_t n = sizes.size() / 2;
  for (const std::size_t first : {std::size_t{0}, n}) {
    double largest = 0.0;
    std::vector<std::size_t> unknown;
    for (std::size_t i = first; i < first + n; ++i) {
      if (const std::optional<double> size = size_of(change, i, energy)) {
        sizes[i] = *size;
        largest = std::max(largest, *size);
      } else {
        unknown.push_back(i);
      }
    }
    for (const std::size_t i : unknown) sizes[i] = largest > 0.0 ? largest : 1.0;
  }
  return sizes;
}

}  // namespace hamgen::app
