// A pendulum let go near the top, 1e5 steps of 0.1, by the emitted integrator.
#include <cmath>
#include <cstdio>

#include "lanes/pendulum.hpp"
#include "orbit.hpp"
#include "pendulum.hpp"

// A scene in the plane leaves out z and pz.
static_assert(sizeof(orbit::plane::State) == 4 * sizeof(double));

int main() {
  using namespace pendulum;
  const Parameters par;
  const State start{3.1, 0.0};
  implicit_midpoint::Propagator propagator(par, 0.1, start);
  double error = 0.0;
  for (int output = 0; output < 1000; ++output) {
    if (!propagator.advance(100).converged) return 1;
    error = std::fmax(error, std::fabs(energy(par, propagator.state()) - energy(par, start)));
  }
  // Four of them at once, one step from rest: each falls by h^2 eps sin(q)/2.
  pendulum::batch_4_libm::State four;
  for (int lane = 0; lane < 4; ++lane) four.q.set(lane, 0.1 * lane);
  pendulum::batch_4_libm::stormer_verlet::Propagator lanes({}, 0.01, four);
  const auto report = lanes.advance(1);
  for (int lane = 0; lane < 4; ++lane) {
    const double fallen = 0.1 * lane - lanes.state().q[lane];
    const double expected = 0.5e-4 * par.eps * std::sin(0.1 * lane);
    if (!report.converged[lane] || std::fabs(fallen - expected) > 1e-15) return 1;
  }
  std::printf("eps %g, energy error %.3e\n", par.eps, error);
  // The midpoint rule conserves H up to h^2 H_2; on this orbit that is 1.4987e-6.
  return error < 1.51e-6 ? 0 : 1;
}
