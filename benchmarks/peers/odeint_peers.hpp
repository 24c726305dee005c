// Boost.odeint: explicit symplectic methods of order 2 and 4, Fehlberg's pair of orders 7 and 8,
// and the extrapolation of Bulirsch and Stoer.
#pragma once

#include <algorithm>
#include <array>
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

namespace odeint = boost::numeric::odeint;

// The stepper chooses its steps.
template <class System, class Stepper>
bool adaptive(Stepper stepper, const System& of, std::vector<double>& z, double time,
              const Observer& observer) {
  typename System::State state = of.state();
  std::ranges::copy(z, state.begin());
  const auto system = [&of](const auto& at, auto& dzdt, double) {
    of.derivative(at.data(), dzdt.data());
  };
  const double first = 1e-3 * time;
  if (observer) {
    odeint::integrate_adaptive(
        stepper, system, state, 0.0, time, first,
        [&](const auto& now, double) { observer(std::vector<double>(now.begin(), now.end())); });
  } else {
    odeint::integrate_adaptive(stepper, system, state, 0.0, time, first);
  }
  std::ranges::copy(state, z.begin());
  return true;
}

// A step of q and p is taken as often as fits.
template <class System, class Step>
bool fixed(const System& system, std::vector<double>& z, double time, double h,
           const Observer& observer, const Step& step) {
  typename System::Half q = system.half();
  typename System::Half p = system.half();
  const auto middle = z.begin() + static_cast<std::ptrdiff_t>(q.size());
  std::copy(z.begin(), middle, q.begin());
  std::copy(middle, z.end(), p.begin());
  const auto give_back = [&] { std::ranges::copy(p, std::ranges::copy(q, z.begin()).out); };
  const auto steps = static_cast<long>(time / h + 0.5);
  for (long i = 0; i < steps; ++i) {
    step(q, p, time / static_cast<double>(steps));
    if (!observer) continue;
    give_back();
    observer(z);
  }
  give_back();
  return true;
}

template <class System>
bool mclachlan(const System& system, std::vector<double>& z, double time, double h,
               const Observer& observer) {
  using Half = typename System::Half;
  odeint::symplectic_rkn_sb3a_mclachlan<Half> stepper;
  const auto force = [&](const Half& q, Half& dpdt) { system.force(q, dpdt); };
  const auto velocity = [&](const Half& p, Half& dqdt) { system.velocity(p, dqdt); };
  if (system.form() == Form::unit_mass) {
    return fixed(system, z, time, h, observer,
                 [&](Half& q, Half& p, double size) { stepper.do_step(force, q, p, 0.0, size); });
  }
  return fixed(system, z, time, h, observer, [&](Half& q, Half& p, double size) {
    stepper.do_step(std::pair(velocity, force), q, p, 0.0, size);
  });
}

// q'' = -V'(q).
template <class System>
bool velocity_verlet(const System& system, std::vector<double>& z, double time, double h,
                     const Observer& observer) {
  using Half = typename System::Half;
  odeint::velocity_verlet<Half> stepper;
  const auto acceleration = [&](const Half& q, const Half&, Half& a, double) {
    system.force(q, a);
  };
  bool begun = false;
  return fixed(system, z, time, h, observer, [&](Half& q, Half& p, double size) {
    if (!std::exchange(begun, true)) {
      Half first = system.half();
      system.force(q, first);
      stepper.initialize(first);
    }
    stepper.do_step(acceleration, std::pair(std::ref(q), std::ref(p)), 0.0, size);
  });
}

template <class System>
std::vector<Peer> odeint_peers(const std::shared_ptr<const System>& system) {
  using State = typename System::State;
  const auto rkf78 = [=](std::vector<double>& z, double time, double tolerance,
                         const Observer& observer) {
    return adaptive(
        odeint::make_controlled<odeint::runge_kutta_fehlberg78<State>>(tolerance, tolerance),
        *system, z, time, observer);
  };
  const auto bulirsch_stoer = [=](std::vector<double>& z, double time, double tolerance,
                                  const Observer& observer) {
    return adaptive(odeint::bulirsch_stoer<State>(tolerance, tolerance), *system, z, time,
                    observer);
  };
  return {{.name = "odeint velocity_verlet",
           .adaptive = false,
           .form = Form::unit_mass,
           .integrate = [=](auto&&... given) { return velocity_verlet(*system, given...); }},
          {.name = "odeint sb3a",
           .adaptive = false,
           .form = Form::separable,
           .integrate = [=](auto&&... given) { return mclachlan(*system, given...); }},
          {.name = "odeint rkf78", .integrate = rkf78},
          {.name = "odeint bulirsch_stoer", .integrate = bulirsch_stoer}};
}

}  // namespace hamgen::peers
