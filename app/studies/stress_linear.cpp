// What linear stability theory says of a cell.
#include <algorithm>
#include <cmath>

#include "app/studies/stress.hpp"

namespace hamgen::app {
namespace {

using Column = std::vector<double>;

double length_of(const Column& x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum);
}

// J S x by central differences of the gradient along x.
class LinearFlow {
 public:
  LinearFlow(const runtime::Library& library, const Column& parameters, const Column& state)
      : library_(library), parameters_(parameters), state_(state) {
    // The cube root of the rounding unit balances truncation against cancellation.
    step_ = 6e-6 * std::max(1.0, length_of(state) / std::sqrt(static_cast<double>(state.size())));
  }

  [[nodiscard]] Column operator()(const Column& x) const {
    const double step = step_ / std::max(length_of(x), 1e-300);
    Column right = state_;
    Column left = state_;
    for (std::size_t i = 0; i < x.size(); ++i) {
      right[i] += step * x[i];
      left[i] -= step * x[i];
    }
    const Column up = library_.gradient(parameters_, right);
    const Column down = library_.gradient(parameters_, left);
    const std::size_t n = x.size() / 2;
    Column result(x.size());
    for (std::size_t i = 0; i < n; ++i) {
      result[i] = (up[n + i] - down[n + i]) / (2.0 * step);
      result[n + i] = -(up[i] - down[i]) / (2.0 * step);
    }
    return result;
  }

 private:
  const runtime::Library& library_;
  const Column& parameters_;
  const Column& state_;
  double step_ = 0.0;
};

}  // namespace

// Oscillations are eigenvalues +-i omega of J S: the power iteration with (J S)^2 finds the largest
// -omega^2, up to the sign.
std::optional<double> fastest_oscillation(const runtime::Library& library,
                                          const std::vector<double>& parameters,
                                          const std::vector<double>& state) {
  const LinearFlow flow(library, parameters, state);
  Column x(state.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = 1.0 + 0.37 * std::cos(2.0 * static_cast<double>(i));
  double before = 0.0;
  for (int iteration = 0; iteration < 300; ++iteration) {
    const double length = length_of(x);
    for (double& value : x) value /= length;
    const Column image = flow(flow(x));
    double quotient = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) quotient -= x[i] * image[i];
    if (!std::isfinite(quotient)) return std::nullopt;
    x = image;
    if (!(length_of(x) > 0.0)) return std::nullopt;
    if (iteration > 4 && std::fabs(quotient - before) < 1e-6 * std::fabs(quotient)) {
      if (quotient > 0.0) return quotient;
      return std::nullopt;
    }
    before = quotient;
  }
  return std::nullopt;
}

}  // namespace hamgen::app
