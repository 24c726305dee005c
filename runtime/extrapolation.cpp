#include "runtime/extrapolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace hamgen::runtime {
namespace {

// 113 bits; a Wide holds 106 of them.
__extension__ typedef __float128 Quad;
using QuadState = std::vector<Quad>;

Quad to_quad(Wide value) { return Quad(value.hi) + Quad(value.lo); }

Wide to_wide(Quad value) {
  const auto hi = static_cast<double>(value);
  return {.hi = hi, .lo = static_cast<double>(value - Quad(hi))};
}

std::vector<Wide> to_wide(const QuadState& values) {
  std::vector<Wide> result(values.size());
  std::ranges::transform(values, result.begin(), [](Quad value) { return to_wide(value); });
  return result;
}

double size(Quad value) { return std::fabs(static_cast<double>(value)); }

// Rows of Aitken and Neville's scheme.  The weights of row k grow like k^(2k)/(2k)!: 250 for k =
// 12, which leaves 30 of quad's 34 digits.
constexpr int kRows = 13;
constexpr int kFewRows = 9;  // with fewer the step may grow

class SmallSteps {
 public:
  SmallSteps(std::shared_ptr<const Library> library, std::vector<Wide> parameters)
      : library_(std::move(library)), parameters_(std::move(parameters)) {}

  // The state after `count` steps of size H/count; empty if one of them failed.
  std::optional<QuadState> many(const QuadState& state, Quad step, int count) {
    Integrator integrator(
        library_, {.parameters = parameters_, .h = to_wide(step / count), .state = to_wide(state)});
    const Report report = integrator.advance(count, false);
    solves_ += report.steps_done;
    if (report.status != Status::done) return {};
    QuadState result;
    for (const Wide value : integrator.state()) result.push_back(to_quad(value));
    return result;
  }

  [[nodiscard]] long long solves() const { return solves_; }

 private:
  std::shared_ptr<const Library> library_;
  std::vector<Wide> parameters_;
  long long solves_ = 0;
};

// The largest |x - y| of a component, relative to its scale: what it is and changes by, and a
// thousandth of the largest scale of all coordinates, or of all momenta.  A component that stays
// zero but for rounding would ask for digits that are not there.
double distance(const QuadState& x, const QuadState& y, const QuadState& before) {
  const std::size_t n = x.size() / 2;
  const auto scale = [&](std::size_t i) { return size(before[i]) + size(x[i] - before[i]); };
  double largest = 0.0;
  for (const std::size_t first : {std::size_t{0}, n}) {
    double common = 0.0;
    for (std::size_t i = first; i < first + n; ++i) common = std::max(common, 1e-3 * scale(i));
    for (std::size_t i = first; i < first + n; ++i) {
      const double difference = size(x[i] - y[i]);
      if (difference != 0.0) largest = std::max(largest, difference / (scale(i) + common));
    }
  }
  return std::isfinite(largest) ? largest : HUGE_VAL;
}

struct Step {
  QuadState state;  // empty if the step is too large
  int rows = 0;
};

// One step; `rows` is the number of rows after which two neighbours agreed.
Step extrapolated_step(SmallSteps& small, const QuadState& before, Quad step, double tolerance) {
  std::vector<QuadState> last;  // the row above: T_(j-1,1), T_(j-1,2), ...
  for (int j = 1; j <= kRows; ++j) {
    std::vector<QuadState> row;
    std::optional<QuadState> first = small.many(before, step, j);
    if (!first) return {};
    row.push_back(std::move(*first));
    for (int l = 1; l < j; ++l) {
      // T_(j,l+1) = T_(j,l) + (T_(j,l) - T_(j-1,l)) / ((j/(j-l))^2 - 1)
      const Quad ratio = Quad(j) / Quad(j - l);
      const Quad weight = Quad(1) / (ratio * ratio - Quad(1));
      const QuadState& left = row.back();
      QuadState next(left.size());
      const QuadState& above = last[static_cast<std::size_t>(l - 1)];
      for (std::size_t i = 0; i < left.size(); ++i)
        next[i] = left[i] + (left[i] - above[i]) * weight;
      row.push_back(std::move(next));
    }
    // The better of the two is kept, so the true error is smaller than what is compared.
    if (j >= 4 && distance(row.back(), row[row.size() - 2], before) <= tolerance)
      return {.state = std::move(row.back()), .rows = j};
    last = std::move(row);
  }
  return {};
}

}  // namespace

Extrapolation extrapolate(const std::shared_ptr<const Library>& library, const InitialValues& start,
                          Wide time, const ExtrapolationOptions& options) {
  if (library->plugin().scalar_digits != 113)
    throw std::invalid_argument("the extrapolation needs an integrator for quad numbers");
  SmallSteps small(library, start.parameters);
  QuadState state;
  for (const Wide value : start.state) state.push_back(to_quad(value));
  const Quad end = to_quad(time);
  Quad now = 0;
  Quad step = end / Quad(options.first_parts);
  Extrapolation result;
  while (now != end && result.failure.empty()) {
    const bool is_last = size(end - now) <= size(step);
    if (is_last) step = end - now;
    const Step next = extrapolated_step(small, state, step, options.tolerance);
    if (next.state.empty()) {
      step /= 2;
      // A smaller step moves t no further than the rounding of a double.
      if (size(step) <= 1e-14 * size(end))
        result.failure =
            fmt::format("no step is small enough at t = {:.10g}", static_cast<double>(now));
    } else {
      state = next.state;
      now = is_last ? end : now + step;
      ++result.steps;
      if (next.rows < kFewRows) step *= 2;
      if (next.rows == kRows) step /= 2;
      if (options.on_progress) options.on_progress(static_cast<double>(now / end));
    }
    if (now != end && options.stop != nullptr && options.stop->load(std::memory_order_relaxed))
      result.failure = fmt::format("stopped at t = {:.10g}", static_cast<double>(now));
  }
  result.state = to_wide(state);
  result.reached = static_cast<double>(now);
  result.solves = small.solves();
  return result;
}

}  // namespace hamgen::runtime
