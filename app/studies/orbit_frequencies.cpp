#include "app/studies/orbit_frequencies.hpp"

#include <algorithm>

namespace hamgen::app {

std::vector<DegreeFrequencies> orbit_frequencies(
    const std::shared_ptr<const runtime::Library>& library, const runtime::InitialValues& start,
    long steps, int count, StopFlag stop) {
  constexpr long kMostSamples = 16384;
  const long stride = std::max(1L, (steps + kMostSamples - 1) / kMostSamples);
  const long samples = steps / stride;
  const std::size_t n = library->degrees_of_freedom();
  std::vector<std::vector<std::complex<double>>> signals(n);
  runtime::Integrator integrator(library, start);
  for (long k = 0; k < samples; ++k) {
    const std::vector<double> z = integrator.rounded_state();
    for (std::size_t i = 0; i < n; ++i) signals[i].emplace_back(z[i], z[n + i]);
    if (is_stopped(stop)) return {};
    if (k + 1 < samples && integrator.advance(stride, false).status != runtime::Status::done)
      return {};
  }
  const double dt = start.h.hi * static_cast<double>(stride);
  std::vector<DegreeFrequencies> result;
  for (const auto& signal : signals) {
    DegreeFrequencies degree{.harmonics = leading_harmonics(signal, dt, count)};
    const std::span<const std::complex<double>> all(signal);
    const auto first = leading_harmonics(all.first(all.size() / 2), dt, 1);
    const auto second = leading_harmonics(all.last(all.size() / 2), dt, 1);
    if (!first.empty() && !second.empty()) degree.change = second[0].frequency - first[0].frequency;
    result.push_back(std::move(degree));
  }
  return result;
}

}  // namespace hamgen::app
