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
  return std::ldexp(1.0, exponent);
}

double one_if_near(double size) {
  const int exponent = std::isfinite(size) && size > 0.0 ? std::ilogb(size) : 0;
  return std::abs(exponent) <= kNearOne ? 1.0 : std::ldexp(1.0, exponent);
}

// |x g|/2 of n components from this one on.
double half_product(const std::vector<double>& x, const std::vector<double>& g, std::size_t first) {
  double sum = 0.0;
  for (std::size_t i = first; i < first + x.size() / 2; ++i) sum += x[i] * g[i];
  return std::abs(sum) / 2;
}

}  // namespace

std::vector<double> natural_sizes(const runtime::Library& library,
                                  const runtime::InitialValues& start, double energy) {
  std::vector<double> sizes(start.state.size(), 1.0);
  if (!(energy > 0.0) || !std::isfinite(energy)) return sizes;
  ChangeOfEnergy change(library, start);
  const std::size_t n = sizes.size() / 2;
  std::vector<std::optional<double>> found;
  for (std::size_t i = 0; i < 2 * n; ++i) found.push_back(size_of(change, i, energy));
  double action = 0.0;  // q times p, whatever the units of the two are
  for (std::size_t i = 0; i < n; ++i) {
    if (found[i] && found[n + i]) action = std::max(action, *found[i] * *found[n + i]);
  }
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const std::optional<double>& partner = found[i < n ? i + n : i - n];
    sizes[i] = one_if_near(found[i].value_or(partner && action > 0.0 ? action / *partner : 1.0));
  }
  return sizes;
}

std::vector<double> natural_sizes(const runtime::Library& library,
                                  const runtime::InitialValues& start) {
  std::vector<double> state;
  for (const runtime::Wide& x : start.state) state.push_back(x.hi);
  std::vector<double> parameters;
  for (const runtime::Wide& x : start.parameters) parameters.push_back(x.hi);
  const std::vector<double> gradient = library.gradient(parameters, state);
  return natural_sizes(
      library, start,
      std::max(half_product(state, gradient, 0), half_product(state, gradient, state.size() / 2)));
}

}  // namespace hamgen::app
