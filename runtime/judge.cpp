#include "runtime/judge.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hamgen::runtime {
namespace {

constexpr double kJump = 10.0;  // energy scales

// In sizes, see Judge::size_of.
constexpr double kFar = 1e3;         // an orbit whose step fails here may have no end to reach
constexpr double kHugeState = 1e50;  // beyond, a step that is not solved is an overflow
// Beyond, all of where H may end is within the rounding of a double.
constexpr double kNoDomain = 1e16;

double largest_component(std::span<const double> state) {
  double largest = 0.0;
  for (const double value : state) largest = std::max(largest, std::fabs(value));
  return largest;
}

std::vector<double> rounded(std::span<const Wide> values) {
  std::vector<double> result(values.size());
  std::ranges::transform(values, result.begin(), &Wide::hi);
  return result;
}

double norm_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

double half_product(std::span<const double> x, std::span<const double> y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return 0.5 * sum;
}

// q H_q/2 and p H_p/2: where H is quadratic in them, their parts of it.
struct HalfProducts {
  double q = 0.0;
  double p = 0.0;
};

HalfProducts half_products(std::span<const double> state, std::span<const double> gradient) {
  const std::size_t n = state.size() / 2;
  return {.q = half_product(state.first(n), gradient.first(n)),
          .p = half_product(state.last(n), gradient.last(n))};
}

// |q| |H_q| + |p| |H_p|, an energy in whatever units q and p are.  Where this is 0 without being at
// rest, |z| |grad H|, which is never less.
double energy_of_sizes(std::span<const double> state, std::span<const double> gradient) {
  const std::size_t n = state.size() / 2;
  const double sum = norm_of(state.first(n)) * norm_of(gradient.first(n)) +
                     norm_of(state.last(n)) * norm_of(gradient.last(n));
  return sum > 0.0 ? sum : norm_of(state) * norm_of(gradient);
}

// The coordinates that move by 1 in a unit of time whatever the state is, as that of `time t` does:
// how far they are says nothing of the orbit.
std::vector<std::size_t> clocks(const Library& library, const std::vector<double>& parameters,
                                const std::vector<double>& state) {
  const std::size_t n = state.size() / 2;
  std::vector<double> elsewhere;
  for (const double value : state) elsewhere.push_back(1.375 * value + 0.625);
  const std::vector<double> here = library.gradient(parameters, state);
  const std::vector<double> there = library.gradient(parameters, elsewhere);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < n; ++i) {
    if (here[n + i] == 1.0 && there[n + i] == 1.0) found.push_back(i);
  }
  return found;
}

}  // namespace

Judge::Judge(std::shared_ptr<const Library> library, std::span<const Wide> parameters,
             std::span<const Wide> start, bool defined_everywhere)
    : library_(std::move(library)),
      parameters_(rounded(parameters)),
      defined_everywhere_(defined_everywhere),
      energy_(library_->energy(parameters, start)) {
  const std::vector<double> whole = rounded(start);
  const std::vector<double> gradient = library_->gradient(parameters_, whole);
  clocks_ = clocks(*library_, parameters_, whole);
  const std::vector<double> state = without_clocks(whole);
  const HalfProducts half = half_products(state, gradient);
  energy_scale_ = std::max(std::fabs(energy_.hi), energy_of_sizes(state, gradient));
  energy_terms_ = std::max({std::fabs(energy_.hi), terms(whole), std::fabs(half.q)});
  q_size_ = std::max(1.0, largest_component(state));
  p_size_ = std::max(q_size_, std::sqrt(2.0 * energy_scale_));
}

std::vector<double> Judge::without_clocks(std::span<const double> state) const {
  std::vector<double> rest(state.begin(), state.end());
  for (const std::size_t clock : clocks_) rest[clock] = 0.0;
  return rest;
}

double Judge::size_of(std::span<const double> whole) const {
  const std::vector<double> rest = without_clocks(whole);
  const std::span<const double> state = rest;
  const std::size_t n = state.size() / 2;
  return std::max(largest_component(state.first(n)) / q_size_,
                  largest_component(state.last(n)) / p_size_);
}

double Judge::jump_limit() const { return kJump * energy_scale_; }

std::optional<double> Judge::raised_limit(double limit, std::span<const double> state,
                                          double energy_error) const {
  constexpr double small = 0.1;
  const double at_state = terms(state);
  const bool has_scale = limit > 0.0;
  if (has_scale && !(energy_error <= small * at_state)) return {};
  return kJump * (has_scale ? energy_error : std::max(at_state, energy_error));
}

bool Judge::keeps_energy(std::span<const double> state, double energy_error) const {
  constexpr double small = 0.1;
  const HalfProducts half =
      half_products(without_clocks(state), library_->gradient(parameters_, state));
  const double scale = std::max(std::fabs(half.q), std::fabs(half.p));
  return std::isfinite(scale) && energy_error <= small * std::max(scale, energy_scale_);
}

double Judge::terms(std::span<const double> state) const {
  const double kinetic = half_products(state, library_->gradient(parameters_, state)).p;
  return std::max(std::fabs(kinetic), std::fabs(library_->energy(parameters_, state) - kinetic));
}

Status Judge::failure(Status reason, std::span<const double> state, double energy_error) const {
  const double size = size_of(state);
  // An orbit that reaches infinity in finite time ends so, however small the step.
  if (size > kFar && keeps_energy(state, energy_error)) return Status::escaped;
  if (reason == Status::jumped) return Status::jumped;
  if (reason == Status::not_converged)
    return size > kHugeState ? Status::overflow : Status::not_converged;
  return defined_everywhere_ || size > kNoDomain ? Status::overflow : Status::left_domain;
}

}  // namespace hamgen::runtime
