// The pair (beta, gamma) with the smallest spread of the energy error.
#pragma once

#include <functional>

#include "benchmarks/paper/pendulum.hpp"

namespace hamgen::paper {

struct Pair {
  long double beta = 0.0L;
  long double gamma = 0.0L;
};

// beta = -h E/12, gamma = -h/12 with E = H(q, 0): the h^2 term of the Hamiltonian that the steps
// follow is then the same all along the orbit.  With c = cos q,
//   H - H(0) = h^2 [ eps^2 (gamma/(2h) + 1/24) (c^2 - c0^2) + eps (beta/h + E/12) (c - c0) ] +
//   O(h^4)
// for alpha = 1/2 and beta, gamma proportional to h.
[[nodiscard]] Pair analytic_pair(long double q, long double h);

// That formula without O(h^4).
[[nodiscard]] long double predicted_error(long double cos_q, const Start& start);

// The minimum of f near `start`, by Nelder and Mead's simplex; `size` is how far off the first
// corners are.  Stops when the simplex is smaller than `tolerance` times `size`.
[[nodiscard]] Pair minimise(const std::function<double(const Pair&)>& f, const Pair& start,
                            const Pair& size, double tolerance = 1e-5);

// The minimum of a function with one valley in [low, high], by golden sections.
[[nodiscard]] long double minimise(const std::function<double(long double)>& f, long double low,
                                   long double high, long double tolerance);

// The best pair for the orbit from rest at q, searched from (0, 0).  The spread is taken over
// `time`.
[[nodiscard]] Pair best_pair(const CompiledScheme& member, long double q, long double h,
                             double time);

}  // namespace hamgen::paper
