// GSL's implicit midpoint rule with a fixed step.
#pragma once
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <cstddef>
#include <memory>

#include "benchmarks/problems.hpp"

namespace hamgen::benchmarks {

// Note [what a step of rk2imp is]
// gsl_odeiv2_step_rk2imp estimates its error by step doubling: one midpoint step of size h and two
// of size h/2, of which it returns the two.  With h it is therefore more exact than the midpoint
// rule with h; with 2h it takes two midpoint steps of size h.  `stride` = 1 is what a user writes
// who wants steps of size h; `stride` = 2 is the cost of the very same trajectory.
//
// gsl_odeiv2_driver_apply_fixed_step would refuse the step for the local error's sake as soon as
// the equations are solved exactly: one tolerance serves both.  Hence gsl_odeiv2_step_apply.
template <class Problem, int stride>
class GslMidpoint {
 public:
  static constexpr const char* name = stride == 1 ? "GSL rk2imp, step h" : "GSL rk2imp, step 2h";
  static constexpr int solves = 2;

  GslMidpoint(const Problem& problem, double h, const State<Problem>& z)
      : problem_(problem), h_(stride * h), z_(z) {
    driver_.reset(
        gsl_odeiv2_driver_alloc_y_new(&system_, gsl_odeiv2_step_rk2imp, h_, tolerance, 0));
  }
  GslMidpoint(const GslMidpoint&) = delete;
  GslMidpoint& operator=(const GslMidpoint&) = delete;

  // `steps` of size h, a multiple of stride.
  bool advance(long long steps) {
    for (long long i = 0; i < steps; i += stride) {
      State<Problem> error;
      const int status = gsl_odeiv2_step_apply(driver_->s, 0.0, h_, z_.data(), error.data(),
                                               nullptr, nullptr, &system_);
      if (status != GSL_SUCCESS) return false;
    }
    return true;
  }
  [[nodiscard]] const State<Problem>& state() const { return z_; }

 private:
  static constexpr std::size_t n = Problem::n;
  // The modified Newton iteration ends where an increment is below it.
  static constexpr double tolerance = 1e-14;

  static int right_hand_side(double, const double* z, double* dzdt, void* data) {
    const Problem& problem = *static_cast<const Problem*>(data);
    Vector<n> q;
    Vector<n> slope;
    Symmetric<n> hessian;
    std::copy_n(z, n, q.begin());
    problem.derivatives(q, slope, hessian);
    for (std::size_t i = 0; i < n; ++i) {
      dzdt[i] = z[n + i];
      dzdt[n + i] = -slope[i];
    }
    return GSL_SUCCESS;
  }

  // d(p, -V')/d(q, p), row by row.
  static int jacobian(double, const double* z, double* matrix, double* dfdt, void* data) {
    const Problem& problem = *static_cast<const Problem*>(data);
    Vector<n> q;
    Vector<n> slope;
    Symmetric<n> hessian;
    std::copy_n(z, n, q.begin());
    problem.derivatives(q, slope, hessian);
    std::fill_n(matrix, 4 * n * n, 0.0);
    std::fill_n(dfdt, 2 * n, 0.0);
    std::size_t entry = 0;
    for (std::size_t i = 0; i < n; ++i) {
      matrix[i * 2 * n + n + i] = 1;
      for (std::size_t j = i; j < n; ++j, ++entry) {
        matrix[(n + i) * 2 * n + j] = -hessian[entry];
        matrix[(n + j) * 2 * n + i] = -hessian[entry];
      }
    }
    return GSL_SUCCESS;
  }

  struct Free {
    void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
  };

  Problem problem_;
  double h_;
  State<Problem> z_;
  gsl_odeiv2_system system_ = {right_hand_side, jacobian, 2 * n, &problem_};
  std::unique_ptr<gsl_odeiv2_driver, Free> driver_;
};

}  // namespace hamgen::benchmarks
