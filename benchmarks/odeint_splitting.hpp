// An explicit symplectic method of order 4 from Boost.odeint.  Another method than the midpoint
// rule, for H = |p|^2/2 + V(q) only: to be read with its energy error.
#pragma once
#include <algorithm>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_mclachlan.hpp>
#include <cstddef>

#include "benchmarks/problems.hpp"

namespace hamgen::benchmarks {

template <class Problem>
class OdeintSplitting {
 public:
  static constexpr const char* name = "odeint sb3a, order 4";
  static constexpr int solves = 0;  // not made of midpoint steps

  OdeintSplitting(const Problem& problem, double h, const State<Problem>& z)
      : problem_(problem), h_(h) {
    std::copy_n(z.begin(), n, q_.begin());
    std::copy_n(z.begin() + n, n, p_.begin());
  }

  bool advance(long long steps) {
    const auto force = [this](const Vector<n>& q, Vector<n>& dpdt) {
      Symmetric<n> hessian;
      problem_.derivatives(q, dpdt, hessian);
      for (double& x : dpdt) x = -x;
    };
    for (long long i = 0; i < steps; ++i) stepper_.do_step(force, q_, p_, 0.0, h_);
    return true;
  }
  [[nodiscard]] State<Problem> state() const {
    State<Problem> z;
    std::copy_n(q_.begin(), n, z.begin());
    std::copy_n(p_.begin(), n, z.begin() + n);
    return z;
  }

 private:
  static constexpr std::size_t n = Problem::n;

  Problem problem_;
  double h_;
  Vector<n> q_ = {};
  Vector<n> p_ = {};
  boost::numeric::odeint::symplectic_rkn_sb3a_mclachlan<Vector<n>> stepper_;
};

}  // namespace hamgen::benchmarks
