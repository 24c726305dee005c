#include "app/studies/event.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <utility>

namespace hamgen::app {

EventLocator::EventLocator(std::shared_ptr<const runtime::Library> library,
                           runtime::InitialValues start, std::size_t invariant, Direction direction)
    : library_(std::move(library)),
      start_(std::move(start)),
      invariant_(invariant),
      direction_(direction) {}

double EventLocator::value(std::span<const runtime::Wide> state) const {
  return library_->invariants(start_.parameters, state).at(invariant_).hi;
}

std::optional<std::vector<runtime::Wide>> EventLocator::step(const std::vector<runtime::Wide>& from,
                                                             double fraction) const {
  runtime::InitialValues part = start_;
  part.h = {start_.h.hi * fraction, start_.h.lo * fraction};
  part.state = from;
  runtime::Integrator integrator(library_, part);
  if (integrator.advance(1, false).status != runtime::Status::done) return std::nullopt;
  return integrator.state();
}

std::optional<Crossing> EventLocator::within(const std::vector<runtime::Wide>& before,
                                             double value_before,
                                             const std::vector<runtime::Wide>& after,
                                             double value_after) const {
  const bool rises = value_before < 0.0 && value_after >= 0.0;
  const bool falls = value_before > 0.0 && value_after <= 0.0;
  if (!(rises && direction_ != Direction::falling) && !(falls && direction_ != Direction::rising))
    return std::nullopt;
  if (value_after == 0.0) return Crossing{1.0, after};
  bool failed = false;
  const auto quantity = [&](double fraction) {
    if (fraction <= 0.0) return value_before;
    if (fraction >= 1.0) return value_after;
    const auto state = step(before, fraction);
    failed = failed || !state;
    return state ? value(*state) : value_after;
  };
  constexpr int kBits = 53;
  std::uintmax_t iterations = 100;
  const auto bracket = boost::math::tools::toms748_solve(
      quantity, 0.0, 1.0, value_before, value_after,
      boost::math::tools::eps_tolerance<double>(kBits), iterations);
  const double fraction = std::abs(quantity(bracket.first)) < std::abs(quantity(bracket.second))
                              ? bracket.first
                              : bracket.second;
  auto state = fraction >= 1.0   ? std::optional(after)
               : fraction <= 0.0 ? std::optional(before)
                                 : step(before, fraction);
  if (failed || !state) return std::nullopt;
  return Crossing{fraction, std::move(*state)};
}

}  // namespace hamgen::app
