// The energy of a pendulum near its separatrix, h = 0.1, by the midpoint rule and by the member of
// the family whose leading energy error vanishes on this orbit.
#include <algorithm>
#include <cstdio>

#include "corrected/pendulum.hpp"
#include "midpoint/pendulum.hpp"
#include "watched/pendulum.hpp"

namespace {

// The largest minus the smallest energy over 20000 steps; negative if a step failed.
template <class Propagator>
double energy_spread(Propagator propagator) {
  const auto energy_now = [&] { return energy(propagator.parameters(), propagator.state()); };
  double lowest = energy_now();
  double highest = lowest;
  for (int step = 0; step < 20000; ++step) {
    if (!propagator.advance(1).converged) return -1.0;
    const double value = energy_now();
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  return highest - lowest;
}

}  // namespace

int main() {
  const double h = 0.1;
  const pendulum::Parameters par;
  const pendulum::State start{3.1, 0.0};
  const double spread = energy_spread(pendulum::implicit_midpoint::Propagator(par, h, start));
  const double corrected_spread = energy_spread(pendulum::corrected::Propagator(par, h, start));
  std::printf("energy spread: midpoint %.4e, corrected %.4e\n", spread, corrected_spread);
  // What its steps conserve instead of H, and how its neighbours move.
  pendulum::State z = start;
  const double before = pendulum::watched::modified_energy({}, h, z);
  double M[2][2];
  pendulum::State dz;
  const pendulum::State first = z;
  if (!pendulum::watched::step({}, h, z).converged) return 1;
  dz.q = z.q - first.q;
  dz.p = z.p - first.p;
  if (!pendulum::watched::tangent({}, h, first, dz, M)) return 1;
  const double area = M[0][0] * M[1][1] - M[0][1] * M[1][0];
  const double change = pendulum::watched::modified_energy({}, h, z) - before;
  if (area < 1 - 1e-14 || area > 1 + 1e-14 || change < -1e-9 || change > 1e-9) return 1;
  // 1.4987e-6 is the error of order h^2 itself; the correction leaves what is of order h^4.
  const bool right =
      spread > 1.48e-6 && spread < 1.51e-6 && corrected_spread >= 0.0 && corrected_spread < 1.3e-12;
  return right ? 0 : 1;
}
