#include "app/studies/ball_solve.hpp"

#include <algorithm>
#include <cmath>

namespace hamgen::app {
namespace {

using Numbers = std::vector<double>;

// Of the largest coordinate, or momentum: what one counts at least.
constexpr double kSmallest = 1e-3;
constexpr int kMostIterations = 40;
constexpr double kLeastRadius = 1e-14;

bool all_finite(const BallVector& values) { return std::ranges::all_of(values, &Ball::is_finite); }

// Y about the inverse, by elimination with partial pivoting; empty if it is singular.
std::vector<Numbers> inverse_of(const BallMatrix& matrix, std::size_t size) {
  std::vector<Numbers> a(size, Numbers(2 * size));
  for (const auto& [place, entry] : matrix)
    a[static_cast<std::size_t>(place.first)][static_cast<std::size_t>(place.second)] =
        entry.nearest();
  for (std::size_t i = 0; i < size; ++i) a[i][size + i] = 1.0;
  for (std::size_t c = 0; c < size; ++c) {
    const auto larger = [c](const Numbers& x, const Numbers& y) {
      return std::fabs(x[c]) < std::fabs(y[c]);
    };
    const auto pivot =
        std::max_element(a.begin() + static_cast<std::ptrdiff_t>(c), a.end(), larger);
    if (!(std::fabs((*pivot)[c]) > 0.0) || !std::isfinite((*pivot)[c])) return {};
    std::swap(a[c], *pivot);
    for (std::size_t j = 2 * size; j-- > c;) a[c][j] /= a[c][c];
    for (std::size_t r = 0; r < size; ++r) {
      const double factor = a[r][c];
      if (r == c || factor == 0.0) continue;
      for (std::size_t j = c; j < 2 * size; ++j) a[r][j] -= factor * a[c][j];
    }
  }
  for (Numbers& row : a) row.erase(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(size));
  return a;
}

BallVector times(const std::vector<Numbers>& y, const BallVector& f) {
  BallVector result(f.size());
  for (std::size_t i = 0; i < f.size(); ++i) {
    for (std::size_t j = 0; j < f.size(); ++j) {
      if (y[i][j] != 0.0) result[i].add_product(Ball(y[i][j], f[j].bits()), f[j]);
    }
  }
  return result;
}

// The sizes that the unknowns are measured by: exact numbers above 0.
Numbers sizes_of(const BallVector& x, const BallEquations& equations) {
  const auto n = static_cast<std::size_t>(equations.degrees_of_freedom);
  const auto is_momentum = [n](std::size_t i) { return n > 0 && i / n % 2 == 1; };
  std::array<double, 2> largest = equations.largest;
  for (std::size_t i = 0; i < x.size(); ++i)
    largest[is_momentum(i)] = std::max(largest[is_momentum(i)], std::fabs(x[i].nearest()));
  const double either = std::max(largest[0], largest[1]);
  for (double& each : largest) {
    if (each == 0.0) each = either > 0.0 ? either : 1.0;
  }
  Numbers sizes;
  for (std::size_t i = 0; i < x.size(); ++i)
    sizes.push_back(std::max(std::fabs(x[i].nearest()), kSmallest * largest[is_momentum(i)]));
  return sizes;
}

double relative_size(const BallVector& change, const Numbers& sizes) {
  double largest = 0.0;
  for (std::size_t i = 0; i < change.size(); ++i)
    largest = std::max(largest, std::fabs(change[i].nearest()) / sizes[i]);
  return largest;
}

// Newton's iteration in numbers of many digits.  Once it is close, the matrix in doubles gains as
// many digits each time as a double has.
struct Found {
  BallVector x;
  std::vector<Numbers> inverse;
  std::string failure;
};
Found iterate(const BallEquations& equations, const BallVector& from) {
  constexpr double close = 1e-7;
  Found found{from, {}, {}};
  const double done = std::ldexp(1.0, static_cast<int>(8 - from.front().bits()));
  double before = HUGE_VAL;
  for (int k = 0; k < kMostIterations; ++k) {
    const BallVector f = equations.residual(found.x);
    if (!all_finite(f)) {
      found.failure = "H has no gradient where the solution was looked for";
      return found;
    }
    if (!(before < close)) {
      found.inverse = inverse_of(equations.jacobian(found.x), f.size());
      if (found.inverse.empty()) {
        found.failure = "the equations have a singular matrix";
        return found;
      }
    }
    const BallVector change = times(found.inverse, f);
    const double size = relative_size(change, sizes_of(found.x, equations));
    for (std::size_t i = 0; i < f.size(); ++i) found.x[i] = (found.x[i] - change[i]).midpoint();
    // What is small and no longer decreases is the rounding of these digits.
    if (size <= done || (size < close * close && size > 0.5 * before)) {
      found.inverse = inverse_of(equations.jacobian(found.x), f.size());
      if (found.inverse.empty()) found.failure = "the equations have a singular matrix";
      return found;
    }
    before = size;
  }
  found.failure = "Newton's iteration finds no solution";
  return found;
}

// |I - Y F'(X)| w by rows, as balls above it.
BallVector contraction(const std::vector<Numbers>& y, const BallMatrix& jacobian,
                       const Numbers& sizes, long bits) {
  const std::size_t size = sizes.size();
  std::vector<BallVector> g(size, BallVector(size));
  for (std::size_t i = 0; i < size; ++i) g[i][i] = Ball(1);
  for (const auto& [place, entry] : jacobian) {
    const auto k = static_cast<std::size_t>(place.first);
    const auto j = static_cast<std::size_t>(place.second);
    for (std::size_t i = 0; i < size; ++i) {
      if (y[i][k] != 0.0) g[i][j].add_product(Ball(-y[i][k], bits), entry);
    }
  }
  BallVector sums(size);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j)
      sums[i].add_product(g[i][j].bound(), Ball(sizes[j], bits));
  }
  return sums;
}

Ball largest(const BallVector& values, const Numbers& sizes, long bits) {
  Ball result;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Ball here = (values[i].bound() / Ball(sizes[i], bits)).bound();
    if (!certainly_less(here, result)) result = here;
  }
  return result;
}

}  // namespace

BallSolution solve_in_balls(const BallEquations& equations, const BallVector& from,
                            bool must_contain, double radius) {
  BallSolution result;
  const long bits = from.front().bits();
  Found found = iterate(equations, from);
  if (!found.failure.empty()) {
    result.failure = found.failure;
    return result;
  }
  const BallVector& x = found.x;
  const Numbers sizes = sizes_of(x, equations);
  const BallVector change = times(found.inverse, equations.residual(x));
  if (!all_finite(change)) {
    result.failure = "H has no gradient at the solution";
    return result;
  }
  double least = kLeastRadius;
  if (must_contain) {
    BallVector away;
    for (std::size_t i = 0; i < x.size(); ++i) away.push_back(x[i] - from[i]);
    least = std::max(least, 2.0 * largest(away, sizes, bits).upper());
  }
  const Ball step = largest(change, sizes, bits);
  for (radius = std::max(radius, least);; radius = std::max(radius / 8.0, least)) {
    BallVector box;
    for (std::size_t i = 0; i < x.size(); ++i)
      box.push_back(x[i].widened(Ball(radius, bits) * Ball(sizes[i], bits)));
    const BallVector g = contraction(found.inverse, equations.jacobian(box), sizes, bits);
    const Ball q = all_finite(g) ? largest(g, sizes, bits) : Ball(2);
    // |Y F(x)|_w + q r < r
    if (certainly_less(q, Ball(1)) &&
        certainly_less(step + q * Ball(radius, bits), Ball(radius, bits))) {
      const Ball error = step / (Ball(1) - q);
      for (std::size_t i = 0; i < x.size(); ++i)
        result.x.push_back(x[i].widened(change[i].bound() + g[i] * error));
      result.radius = radius;
      return result;
    }
    if (radius <= least) break;
  }
  result.failure = "no neighbourhood with one solution was found";
  return result;
}

}  // namespace hamgen::app
