#include "benchmarks/paper/optimum.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hamgen::paper {
namespace {

struct Corner {
  Pair at;
  double value = 0.0;
};

// a + factor (b - a).
Pair between(const Pair& a, const Pair& b, long double factor) {
  return {.beta = a.beta + factor * (b.beta - a.beta),
          .gamma = a.gamma + factor * (b.gamma - a.gamma)};
}

}  // namespace

Pair analytic_pair(long double q, long double h) {
  return {.beta = -h * hamiltonian(q, 0.0L) / 12, .gamma = -h / 12};
}

long double predicted_error(long double cos_q, const Start& start) {
  const long double h = start.h;
  const long double c0 = std::cos(start.q);
  const long double energy = hamiltonian(start.q, 0.0L);
  const long double quadratic = kEps * kEps * (start.gauge.gamma / (2 * h) + 1.0L / 24);
  const long double linear = kEps * (start.gauge.beta / h + energy / 12);
  return h * h * (quadratic * (cos_q * cos_q - c0 * c0) + linear * (cos_q - c0));
}

Pair minimise(const std::function<double(const Pair&)>& f, const Pair& start, const Pair& size,
              double tolerance) {
  const auto corner = [&f](const Pair& at) { return Corner{.at = at, .value = f(at)}; };
  std::array corners = {corner(start),
                        corner({.beta = start.beta + size.beta, .gamma = start.gamma}),
                        corner({.beta = start.beta, .gamma = start.gamma + size.gamma})};
  const auto extent = [&] {
    double largest = 0.0;
    for (const Corner& c : corners) {
      const Pair& best = corners[0].at;
      largest =
          std::max({largest, static_cast<double>(std::fabs((c.at.beta - best.beta) / size.beta)),
                    static_cast<double>(std::fabs((c.at.gamma - best.gamma) / size.gamma))});
    }
    return largest;
  };
  for (int i = 0; i < 400; ++i) {
    std::ranges::sort(corners, {}, &Corner::value);
    if (extent() < tolerance) break;
    const Pair middle = between(corners[0].at, corners[1].at, 0.5L);
    const Corner reflected = corner(between(middle, corners[2].at, -1.0L));
    if (reflected.value < corners[0].value) {
      const Corner expanded = corner(between(middle, corners[2].at, -2.0L));
      corners[2] = expanded.value < reflected.value ? expanded : reflected;
    } else if (reflected.value < corners[1].value) {
      corners[2] = reflected;
    } else {
      const bool outside = reflected.value < corners[2].value;
      const Corner contracted = corner(between(middle, corners[2].at, outside ? -0.5L : 0.5L));
      if (contracted.value < std::min(reflected.value, corners[2].value)) {
        corners[2] = contracted;
      } else {
        for (const std::size_t k : {1U, 2U})
          corners[k] = corner(between(corners[0].at, corners[k].at, 0.5L));
      }
    }
  }
  return corners[0].at;
}

long double minimise(const std::function<double(long double)>& f, long double low, long double high,
                     long double tolerance) {
  const long double section = (3 - std::sqrt(5.0L)) / 2;
  long double a = low + section * (high - low);
  long double b = high - section * (high - low);
  double at_a = f(a);
  double at_b = f(b);
  while (high - low > tolerance) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = low + section * (high - low);
      at_a = f(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = high - section * (high - low);
      at_b = f(b);
    }
  }
  return (low + high) / 2;
}

Pair best_pair(const CompiledScheme& member, long double q, long double h, double time) {
  const auto steps = static_cast<long>(std::ceil(time / static_cast<double>(h)));
  const auto spread = [&](const Pair& pair) {
    return integrate(member, {.q = q, .h = h, .gauge = {0.5L, pair.beta, pair.gamma}}, steps)
        .spread();
  };
  // A minimax has a kink at its minimum, where a simplex may collapse too early: it is set up anew,
  // smaller each time.
  Pair best;
  Pair size = {.beta = -h / 1000, .gamma = -h / 10};
  for (int round = 0; round < 5; ++round) {
    best = minimise(spread, best, size, 1e-3);
    size = {.beta = size.beta / 50, .gamma = size.gamma / 50};
  }
  return best;
}

}  // namespace hamgen::paper
