// How exact the measured steps are, so that times are compared between like and like.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "benchmarks/problems.hpp"

namespace hamgen::benchmarks {

struct Accuracy {
  bool converged = true;
  double energy_spread = 0;  // max H - min H
  double energy_drift = 0;   // mean H of the last tenth of the run less that of the first
  double step_error = 0;     // max |Z - Z*| over all steps; Z* the midpoint rule's exact image of z
};

// The midpoint rule solved in long double by fixed-point iteration: a factor h^2/4 |V''| < 3e-3 an
// iteration, so that ten leave less than its round-off.
template <class Problem>
Vector<2 * Problem::n, long double> exact_midpoint(const Problem& problem, long double h,
                                                   const Vector<2 * Problem::n, long double>& z) {
  constexpr std::size_t n = Problem::n;
  Vector<n, long double> q_bar;
  std::copy_n(z.begin(), n, q_bar.begin());
  Vector<n, long double> slope;
  Symmetric<n, long double> hessian;
  Vector<2 * n, long double> next = z;
  for (int iteration = 0; iteration < 10; ++iteration) {
    problem.derivatives(q_bar, slope, hessian);
    for (std::size_t i = 0; i < n; ++i) q_bar[i] = z[i] + h / 2 * (z[n + i] - h / 2 * slope[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    next[i] = z[i] + 2 * (q_bar[i] - z[i]);
    next[n + i] = z[n + i] - h * slope[i];
  }
  return next;
}

// `steps` of size h; a method that takes two at a time is looked at every second.
template <class Method, class Problem>
Accuracy accuracy_of(const Problem& problem, int stride, long long steps) {
  Method method(problem, Problem::h, Problem::start);
  Accuracy result;
  const long double start = energy(problem, Problem::start);
  double least = 0;
  double most = 0;
  double first = 0;
  double last = 0;
  for (long long i = 0; i < steps; i += stride) {
    const State<Problem> before = method.state();
    if (!method.advance(stride)) {
      result.converged = false;
      return result;
    }
    const State<Problem> after = method.state();
    const double error = static_cast<double>(energy(problem, after) - start);
    least = std::min(least, error);
    most = std::max(most, error);
    const double weight = 10.0 * stride / static_cast<double>(steps);
    if (i < steps / 10) first += weight * error;
    if (i >= steps - steps / 10) last += weight * error;
    if (Method::solves == 0) continue;
    Vector<2 * Problem::n, long double> exact;
    std::copy(before.begin(), before.end(), exact.begin());
    for (int k = 0; k < Method::solves; ++k) {
      exact = exact_midpoint(problem,
                             stride * static_cast<long double>(Problem::h) / Method::solves, exact);
    }
    for (std::size_t c = 0; c < exact.size(); ++c) {
      result.step_error =
          std::max(result.step_error, static_cast<double>(std::fabs(after[c] - exact[c])));
    }
  }
  result.energy_spread = most - least;
  result.energy_drift = last - first;
  return result;
}

}  // namespace hamgen::benchmarks
