// A header of generated/ in a project without hamgen: the paper's pendulum, 1e5 steps of 0.1.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pendulum.hpp"

int main() {
  using namespace pendulum;
  const Parameters par;
  State state;
  state.q = 3.1;
  implicit_midpoint::Propagator propagator(par, 0.1, state);
  double lowest = energy(par, state);
  double highest = lowest;
  for (int i = 0; i < 100000; ++i) {
    if (!propagator.advance(1).converged) return 1;
    const double value = energy(par, propagator.state());
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  std::printf("energy spread %.4e\n", highest - lowest);
  // One step by itself agrees with the first of many.
  const implicit_midpoint::StepReport report = implicit_midpoint::step(par, 0.1, state);
  if (!report.converged || !(state.q < 3.1)) return 1;
  // The leading error h^2 H_2 of the midpoint rule, to one percent.
  return std::abs((highest - lowest) / 1.4987e-6 - 1.0) < 0.01 ? 0 : 1;
}
