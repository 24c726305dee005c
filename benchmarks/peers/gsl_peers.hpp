// GSL: the pair of Prince and Dormand, orders 8 and 9, and the implicit midpoint rule.
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/peers/peer.hpp"

namespace hamgen::peers {

// What GSL calls.
template <class System>
struct GslSystem {
  static int derivative(double, const double* z, double* dzdt, void* data) {
    static_cast<const System*>(data)->derivative(z, dzdt);
    return GSL_SUCCESS;
  }
  // Of the right-hand side, row by row, by forward differences: the iteration only needs it to
  // contract.
  static int jacobian(double, const double* z, double* matrix, double* dfdt, void* data) {
    const System& system = *static_cast<const System*>(data);
    typename System::State at = system.state();
    const std::size_t size = at.size();
    typename System::State base = system.state();
    typename System::State moved = system.state();
    std::copy_n(z, size, at.begin());
    system.derivative(z, base.data());
    for (std::size_t j = 0; j < size; ++j) {
      const double difference = 1.5e-8 * std::max(1.0, std::fabs(z[j]));
      at[j] += difference;
      system.derivative(at.data(), moved.data());
      for (std::size_t i = 0; i < size; ++i)
        matrix[i * size + j] = (moved[i] - base[i]) / difference;
      at[j] = z[j];
    }
    std::fill_n(dfdt, size, 0.0);
    return GSL_SUCCESS;
  }
  static gsl_odeiv2_system of(const System& system) {
    return {derivative, jacobian, 2 * system.degrees_of_freedom(), const_cast<System*>(&system)};
  }
};

struct FreeDriver {
  void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
};
using GslDriver = std::unique_ptr<gsl_odeiv2_driver, FreeDriver>;

template <class System>
bool rk8pd(const System& of, std::vector<double>& z, double time, double tolerance,
           const Observer& observer) {
  gsl_odeiv2_system system = GslSystem<System>::of(of);
  const GslDriver driver(gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-3 * time,
                                                       tolerance, tolerance));
  double t = 0.0;
  double h = 1e-3 * time;
  while (t < time) {
    const int status =
        gsl_odeiv2_evolve_apply(driver->e, driver->c, driver->s, &system, &t, time, &h, z.data());
    if (status != GSL_SUCCESS) return false;
    if (observer) observer(z);
  }
  return true;
}

template <class System>
bool rk2imp(const System& of, std::vector<double>& z, double time, double h,
            const Observer& observer) {
  gsl_odeiv2_system system = GslSystem<System>::of(of);
  constexpr double solved_to = 1e-13;
  const GslDriver driver(
      gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk2imp, h, solved_to, 0.0));
  std::vector<double> error(z.size());
  const auto steps = static_cast<long>(time / h + 0.5);
  for (long i = 0; i < steps; ++i) {
    if (gsl_odeiv2_step_apply(driver->s, 0.0, time / static_cast<double>(steps), z.data(),
                              error.data(), nullptr, nullptr, &system) != GSL_SUCCESS)
      return false;
    if (observer) observer(z);
  }
  return true;
}

template <class System>
std::vector<Peer> gsl_peers(const std::shared_ptr<const System>& system) {
  gsl_set_error_handler_off();
  return {
      {.name = "GSL rk8pd", .integrate = [=](auto&&... given) { return rk8pd(*system, given...); }},
      {.name = "GSL rk2imp",
       .adaptive = false,
       .most_degrees_of_freedom = 150,  // a dense matrix
       .integrate = [=](auto&&... given) { return rk2imp(*system, given...); }}};
}

}  // namespace hamgen::peers
