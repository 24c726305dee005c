// Boost.odeint: an explicit symplectic method of order 4, Fehlberg's pair of orders 7 and 8, and
// the extrapolation of Bulirsch and Stoer.
#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_mclachlan.hpp>

#include "benchmarks/peers/peer.hpp"

namespace hamgen::peers {
namespace {

namespace odeint = boost::numeric::odeint;
using State = std::vector<double>;

struct RightHandSide {
  const Flow* flow;
  void operator()(const State& z, State& dzdt, double) const {
    flow->derivative(z.data(), dzdt.data());
  }
};

// The stepper chooses its steps; `first` is where it starts.
template <class Stepper>
bool adaptive(Stepper stepper, const Flow& flow, State& z, double time, double first,
              const Observer& observer) {
  const RightHandSide system{&flow};
  if (observer) {
    odeint::integrate_adaptive(stepper, system, z, 0.0, time, first,
                               [&observer](const State& now, double) { observer(now); });
  } else {
    odeint::integrate_adaptive(stepper, system, z, 0.0, time, first);
  }
  return true;
}

bool rkf78(const Flow& flow, State& z, double time, double tolerance, const Observer& observer) {
  return adaptive(
      odeint::make_controlled<odeint::runge_kutta_fehlberg78<State>>(tolerance, tolerance), flow, z,
      time, 1e-3 * time, observer);
}

bool bulirsch_stoer(const Flow& flow, State& z, double time, double tolerance,
                    const Observer& observer) {
  return adaptive(odeint::bulirsch_stoer<State>(tolerance, tolerance), flow, z, time, 1e-3 * time,
                  observer);
}

// q' = p, p' = -V'(q): the stepper asks for the force only.
bool mclachlan(const Flow& flow, State& z, double time, double h, const Observer& observer) {
  const std::size_t n = flow.n();
  State q(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(n));
  State p(z.begin() + static_cast<std::ptrdiff_t>(n), z.end());
  State at = z;
  State gradient(2 * n);
  const auto force = [&](const State& position, State& dpdt) {
    std::copy(position.begin(), position.end(), at.begin());
    flow.gradient(at.data(), gradient.data());
    for (std::size_t i = 0; i < n; ++i) dpdt[i] = -gradient[i];
  };
  odeint::symplectic_rkn_sb3a_mclachlan<State> stepper;
  const auto steps = static_cast<long>(time / h + 0.5);
  for (long i = 0; i < steps; ++i) {
    stepper.do_step(force, q, p, 0.0, time / static_cast<double>(steps));
    if (!observer) continue;
    std::copy(q.begin(), q.end(), z.begin());
    std::copy(p.begin(), p.end(), z.begin() + static_cast<std::ptrdiff_t>(n));
    observer(z);
  }
  std::copy(q.begin(), q.end(), z.begin());
  std::copy(p.begin(), p.end(), z.begin() + static_cast<std::ptrdiff_t>(n));
  return true;
}

}  // namespace

std::vector<Peer> odeint_peers() {
  return {
      {.name = "odeint sb3a", .adaptive = false, .needs_unit_mass = true, .integrate = mclachlan},
      {.name = "odeint rkf78", .integrate = rkf78},
      {.name = "odeint bulirsch_stoer", .integrate = bulirsch_stoer}};
}

}  // namespace hamgen::peers
