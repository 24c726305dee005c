// GSL: the pair of Prince and Dormand, orders 8 and 9, and the implicit midpoint rule.
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/peers/peer.hpp"

namespace hamgen::peers {
namespace {

int derivative(double, const double* z, double* dzdt, void* data) {
  static_cast<const Flow*>(data)->derivative(z, dzdt);
  return GSL_SUCCESS;
}

// Of the right-hand side, row by row, by forward differences: the iteration only needs it to
// contract.
int jacobian(double, const double* z, double* matrix, double* dfdt, void* data) {
  const Flow& flow = *static_cast<const Flow*>(data);
  const std::size_t size = 2 * flow.n();
  std::vector<double> at(z, z + size);
  std::vector<double> base(size);
  std::vector<double> moved(size);
  flow.derivative(z, base.data());
  for (std::size_t j = 0; j < size; ++j) {
    const double difference = 1.5e-8 * std::max(1.0, std::fabs(z[j]));
    at[j] += difference;
    flow.derivative(at.data(), moved.data());
    for (std::size_t i = 0; i < size; ++i) matrix[i * size + j] = (moved[i] - base[i]) / difference;
    at[j] = z[j];
  }
  std::fill_n(dfdt, size, 0.0);
  return GSL_SUCCESS;
}

struct Free {
  void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
};

bool with_tolerance(const gsl_odeiv2_step_type* type, const Flow& flow, std::vector<double>& z,
                    double time, double tolerance, const Observer& observer) {
  gsl_odeiv2_system system{derivative, jacobian, z.size(), const_cast<Flow*>(&flow)};
  const std::unique_ptr<gsl_odeiv2_driver, Free> driver(
      gsl_odeiv2_driver_alloc_y_new(&system, type, 1e-3 * time, tolerance, tolerance));
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

bool rk8pd(const Flow& flow, std::vector<double>& z, double time, double tolerance,
           const Observer& observer) {
  return with_tolerance(gsl_odeiv2_step_rk8pd, flow, z, time, tolerance, observer);
}

bool rk2imp(const Flow& flow, std::vector<double>& z, double time, double h,
            const Observer& observer) {
  gsl_odeiv2_system system{derivative, jacobian, z.size(), const_cast<Flow*>(&flow)};
  constexpr double solved_to = 1e-13;
  const std::unique_ptr<gsl_odeiv2_driver, Free> driver(
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

}  // namespace

std::vector<Peer> gsl_peers() {
  gsl_set_error_handler_off();
  return {{.name = "GSL rk8pd", .integrate = rk8pd},
          {.name = "GSL rk2imp",
           .adaptive = false,
           .most_degrees_of_freedom = 100,  // a dense matrix
           .integrate = rk2imp}};
}

}  // namespace hamgen::peers
