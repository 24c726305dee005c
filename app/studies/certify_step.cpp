#include "app/studies/certify_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/studies/ball_step.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

// Twice the digits of the scalar: an error of a unit of rounding is known to as many digits.
long bits_of(int scalar_digits) { return std::max(128, 2 * scalar_digits + 32); }

Ball sum_of(const ExactSum& parts, long bits) { return Ball::exact_sum(parts, bits); }

BallVector model_state(const ModelState& state, const std::vector<ExactSum>& values, long bits) {
  BallVector result;
  if (state.factors.empty()) {
    for (const ExactSum& value : values) result.push_back(sum_of(value, bits));
  }
  for (std::size_t i = 0; i < state.factors.size(); ++i) {
    Ball sum(state.constant[i], bits);
    for (const auto& [place, factor] : state.factors[i])
      sum.add_product(Ball(factor, bits), sum_of(values[static_cast<std::size_t>(place)], bits));
    result.push_back(std::move(sum));
  }
  return result;
}

std::map<std::string, Ball> balls_of(const std::map<std::string, ExactSum>& values, long bits) {
  std::map<std::string, Ball> result;
  for (const auto& [name, value] : values) result.emplace(name, sum_of(value, bits));
  return result;
}

}  // namespace

struct StepCertifier::Balls {
  Balls(const Model& model_read, const Scheme& scheme, const StepNumbers& numbers,
        ModelState of_step)
      : state(std::move(of_step)),
        bits(bits_of(numbers.scalar_digits)),
        epsilon(std::ldexp(1.0, 1 - numbers.scalar_digits)),
        model(model_read, balls_of(numbers.values, bits), bits),
        step(model, scheme, balls_of(numbers.values, bits), sum_of(numbers.values.at("h"), bits)) {}

  ModelState state;
  long bits;
  double epsilon;
  BallModel model;
  BallStep step;
};

void StepCertifier::require_possible(const Model& model, const Scheme& scheme) {
  const auto n = static_cast<std::size_t>(degrees_of_freedom(model));
  if (const std::string why = BallStep::refusal(scheme, n); !why.empty())
    throw UsageError(fmt::format("{} cannot be certified: {}", scheme.name, why));
  if (const std::string name = function_without_derivatives(model); !name.empty())
    throw UsageError(fmt::format(
        "{} cannot be certified: the function {} has no derivatives in balls", model.name, name));
}

StepCertifier::StepCertifier(const Model& model, const Scheme& scheme, const StepNumbers& numbers,
                             ModelState state) {
  require_possible(model, scheme);
  balls_ = std::make_unique<Balls>(model, scheme, numbers, std::move(state));
}

StepCertifier::~StepCertifier() = default;

StepDistance StepCertifier::distance(const std::vector<ExactSum>& before,
                                     const std::vector<ExactSum>& after) {
  const BallVector z = model_state(balls_->state, before, balls_->bits);
  const BallVector computed = model_state(balls_->state, after, balls_->bits);
  const BallSolution exact = balls_->step.step(z, computed);
  StepDistance result{.radius = exact.radius, .failure = exact.failure};
  if (!result.failure.empty()) return result;
  double largest = 0.0;
  for (const Ball& value : computed) largest = std::max(largest, std::fabs(value.nearest()));
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double away = (computed[i] - exact.x[i]).bound().upper();
    const double size = std::max(std::fabs(z[i].nearest()), std::fabs(computed[i].nearest()));
    const double unit = balls_->epsilon * (size + largest / 1024.0);
    if (away > 0.0 && unit < std::numeric_limits<double>::min()) {
      result.failure = "the state is too small for a unit of rounding in doubles";
      return result;
    }
    constexpr double upwards = 1.0 + 1e-14;  // of the doubles that follow
    const double units = away == 0.0 ? 0.0 : away / unit * upwards;
    if (units <= result.units) continue;
    result.units = units;
    result.component = i;
  }
  return result;
}

}  // namespace hamgen::app
