// Boost.odeint: explicit symplectic methods of order 2 and 4, Fehlberg's pair of orders 7 and 8,
// and the extrapolation of Bulirsch and Stoer.
#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_mclachlan.hpp>
#include <boost/numeric/odeint/stepper/velocity_verlet.hpp>
#include <functional>
#include <utility>

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

// The two halves of a state, and the derivatives that a stepper of separable systems asks for.
class Halves {
 public:
  Halves(const Flow& flow, State& z)
      : flow_(flow), z_(z), q(z.begin(), middle()), p(middle(), z.end()), at_(z), gradient_(z) {}

  // p' = -V'(q).
  void force(const State& position, State& dpdt) {
    std::ranges::copy(position, at_.begin());
    flow_.gradient(at_.data(), gradient_.data());
    for (std::size_t i = 0; i < dpdt.size(); ++i) dpdt[i] = -gradient_[i];
  }
  // q' = T'(p).
  void velocity(const State& momentum, State& dqdt) {
    std::copy(momentum.begin(), momentum.end(), at_.end() - static_cast<std::ptrdiff_t>(p.size()));
    flow_.gradient(at_.data(), gradient_.data());
    for (std::size_t i = 0; i < dqdt.size(); ++i) dqdt[i] = gradient_[dqdt.size() + i];
  }
  void give_back() { std::ranges::copy(p, std::ranges::copy(q, z_.begin()).out); }

 private:
  [[nodiscard]] State::iterator middle() const {
    return z_.begin() + static_cast<std::ptrdiff_t>(flow_.n());
  }

  const Flow& flow_;
  State& z_;

 public:
  State q, p;

 private:
  State at_, gradient_;
};

// `step(size)` is taken as often as fits.
template <class Step>
void fixed(Halves& halves, State& z, double time, double h, const Observer& observer, Step step) {
  const auto steps = static_cast<long>(time / h + 0.5);
  for (long i = 0; i < steps; ++i) {
    step(time / static_cast<double>(steps));
    if (!observer) continue;
    halves.give_back();
    observer(z);
  }
  halves.give_back();
}

bool mclachlan(const Flow& flow, State& z, double time, double h, const Observer& observer) {
  Halves halves(flow, z);
  odeint::symplectic_rkn_sb3a_mclachlan<State> stepper;
  const auto force = [&](const State& q, State& dpdt) { halves.force(q, dpdt); };
  const auto velocity = [&](const State& p, State& dqdt) { halves.velocity(p, dqdt); };
  const bool momenta_are_velocities = flow.form(z) == Form::unit_mass;
  fixed(halves, z, time, h, observer, [&](double size) {
    if (momenta_are_velocities) {
      stepper.do_step(force, halves.q, halves.p, 0.0, size);
    } else {
      stepper.do_step(std::pair(velocity, force), halves.q, halves.p, 0.0, size);
    }
  });
  return true;
}

// q'' = -V'(q).
bool velocity_verlet(const Flow& flow, State& z, double time, double h, const Observer& observer) {
  Halves halves(flow, z);
  odeint::velocity_verlet<State> stepper;
  const auto acceleration = [&](const State& q, const State&, State& a, double) {
    halves.force(q, a);
  };
  State first(flow.n());
  halves.force(halves.q, first);
  stepper.initialize(first);
  fixed(halves, z, time, h, observer, [&](double size) {
    stepper.do_step(acceleration, std::pair(std::ref(halves.q), std::ref(halves.p)), 0.0, size);
  });
  return true;
}

}  // namespace

std::vector<Peer> odeint_peers() {
  return {
      {.name = "odeint velocity_verlet",
       .adaptive = false,
       .form = Form::unit_mass,
       .integrate = velocity_verlet},
      {.name = "odeint sb3a", .adaptive = false, .form = Form::separable, .integrate = mclachlan},
      {.name = "odeint rkf78", .integrate = rkf78},
      {.name = "odeint bulirsch_stoer", .integrate = bulirsch_stoer}};
}

}  // namespace hamgen::peers
