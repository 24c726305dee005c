#include "app/studies/orbit_frequencies.hpp"

#include <algorithm>

namespace hamgen::app {
namespace {

using Signal = std::vector<std::complex<double>>;

// Every step is one: what is left out would fold frequencies.
constexpr long kMostSamples = 65536;

}  // namespace

std::vector<DegreeFrequencies> orbit_frequencies(
    const std::shared_ptr<const runtime::Library>& library, const runtime::InitialValues& start,
    long steps, int count, StopFlag stop) {
  const long most = std::min(steps, kMostSamples);
  const long half = most / 2;
  const std::size_t n = library->degrees_of_freedom();
  std::vector<Signal> first_part(n);
  std::vector<Signal> last_half(n);
  runtime::Integrator integrator(library, start);
  for (long k = 0; k < steps;) {
    const std::vector<double> z = integrator.rounded_state();
    for (std::size_t i = 0; i < n; ++i) {
      if (k < most) first_part[i].emplace_back(z[i], z[n + i]);
      if (k >= steps - half) last_half[i].emplace_back(z[i], z[n + i]);
    }
    if (is_stopped(stop)) return {};
    const long next = k + 1 < most || k + 1 > steps - half ? k + 1 : steps - half;
    if (next < steps && integrator.advance(next - k, false).status != runtime::Status::done)
      return {};
    k = next;
  }
  const double dt = start.h.hi;
  std::vector<DegreeFrequencies> result;
  for (std::size_t i = 0; i < n; ++i) {
    const Signal& signal = first_part[i];
    DegreeFrequencies degree{.harmonics = leading_harmonics(signal, dt, count)};
    const auto first = leading_harmonics(std::span(signal).first(last_half[i].size()), dt, 1);
    const auto second = leading_harmonics(last_half[i], dt, 1);
    if (!first.empty() && !second.empty()) degree.change = second[0].frequency - first[0].frequency;
    result.push_back(std::move(degree));
  }
  return result;
}

}  // namespace hamgen::app
