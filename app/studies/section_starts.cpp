#include "app/studies/section_starts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "generator/base/diagnostic.hpp"

namespace hamgen::app {
namespace {

using State = std::vector<runtime::Wide>;

std::vector<double> rounded_values(const State& state) {
  std::vector<double> values;
  for (const runtime::Wide& x : state) values.push_back(x.hi);
  return values;
}

double size_at(const SectionRequest& request, std::size_t place) {
  return request.sizes.empty() ? 1.0 : request.sizes[place];
}

// H - energy with another momentum at its place.
class EnergyOfMomentum {
 public:
  EnergyOfMomentum(const SectionRequest& request, State state)
      : request_(request), state_(std::move(state)) {}

  double operator()(double p) {
    state_[request_.momentum] = {p, 0.0};
    return request_.library->energy(request_.start.parameters, state_).hi - request_.energy;
  }
  // dH/dp there.
  double slope(double p) {
    (*this)(p);
    std::vector<double> parameters;
    for (const runtime::Wide& x : request_.start.parameters) parameters.push_back(x.hi);
    return request_.library->gradient(parameters, rounded_values(state_))[request_.momentum];
  }

 private:
  const SectionRequest& request_;
  State state_;
};

// Does the quantity that is zero on the surface change in the direction that is asked for?
bool goes_the_right_way(const SectionRequest& request, const State& state) {
  if (request.direction == runtime::Direction::both) return true;
  constexpr double kLittle = 1e-3;  // of a step
  const auto value = [&](const State& at) {
    return request.library->invariants(request.start.parameters, at)[0].hi;
  };
  const auto after = runtime::part_of_step(request.library, request.start, state, {kLittle, 0.0});
  if (!after) return false;
  const double change = value(*after) - value(state);
  return (request.start.h.hi > 0 ? change : -change) *
             (request.direction == runtime::Direction::rising ? 1.0 : -1.0) >
         0.0;
}

// The states of a grid over the rectangle that have the energy, and those connected with the cell
// of the scene's start, as a rectangle.
class Region {
 public:
  Region(const SectionRequest& request, double x, double y)
      : request_(request),
        x_(x),
        y_(y),
        width_(first_half_side(size_at(request, request.first), x)),
        height_(first_half_side(size_at(request, request.second), y)) {}

  [[nodiscard]] std::array<double, 4> rectangle() {
    Side across{.length = &width_, .turns = request_.first_turns};
    Side up{.length = &height_, .turns = request_.second_turns};
    while (true) {
      const std::array<double, 4> found = connected();
      const bool wider = across.fit(reaches_x_, found[1] - found[0]);
      const bool higher = up.fit(reaches_y_, found[3] - found[2]);
      if (is_stopped(request_.stop)) return found;
      if (wider || higher) continue;
      const bool ends_across = across.ends(reaches_x_);
      const bool ends_up = up.ends(reaches_y_);
      return ends_across && ends_up ? found : connected();
    }
  }

 private:
  static constexpr int kCells = 48;

  static double first_half_side(double size, double middle) {
    return size == 1.0 ? std::max(1.0, 2 * std::abs(middle)) : size;
  }

  // Half a side of the grid, which is doubled while the region reaches it and, if it was not,
  // halved while the region is a few cells, of which some may be on the other side of a barrier.
  struct Side {
    double* length;
    bool turns;  // is it of an angle?
    int doublings = 0, halvings = 0;

    bool fit(bool is_reached, double extent) {
      constexpr int kMostDoublings = 8;
      constexpr int kMostHalvings = 40;
      if (is_reached && halvings == 0 && doublings < kMostDoublings) {
        ++doublings;
        *length *= 2;
        return true;
      }
      if (!is_reached && doublings == 0 && halvings < kMostHalvings && extent < *length / 4) {
        ++halvings;
        *length /= 2;
        return true;
      }
      return false;
    }
    // Where the region has no end, half of it is far from the scene's start: what was looked at
    // first is kept of it; of an angle it is a turn.
    bool ends(bool is_reached) {
      if (!is_reached || doublings == 0) return true;
      *length = turns ? std::numbers::pi : std::ldexp(*length, -doublings);
      return false;
    }
  };

  [[nodiscard]] double first(int i) const { return x_ + width_ * (2.0 * i / kCells - 1.0); }
  [[nodiscard]] double second(int j) const { return y_ + height_ * (2.0 * j / kCells - 1.0); }

  [[nodiscard]] bool has_energy(int i, int j) const {
    State state = request_.start.state;
    state[request_.first] = {first(i), 0.0};
    state[request_.second] = {second(j), 0.0};
    if (request_.fixed) state[request_.fixed->first] = {request_.fixed->second, 0.0};
    return with_energy(request_, std::move(state)).has_value();
  }

  [[nodiscard]] std::array<double, 4> connected() {
    reaches_x_ = reaches_y_ = false;
    std::array<double, 4> box{x_, x_, y_, y_};
    std::set<std::pair<int, int>> seen{{kCells / 2, kCells / 2}};
    std::vector<std::pair<int, int>> open{{kCells / 2, kCells / 2}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      box = {std::min(box[0], first(i)), std::max(box[1], first(i)), std::min(box[2], second(j)),
             std::max(box[3], second(j))};
      reaches_x_ = reaches_x_ || i == 0 || i == kCells;
      reaches_y_ = reaches_y_ || j == 0 || j == kCells;
      for (const auto& [k, l] : {std::pair{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}) {
        if (k < 0 || l < 0 || k > kCells || l > kCells || !seen.insert({k, l}).second) continue;
        if (has_energy(k, l)) open.emplace_back(k, l);
      }
    }
    return box;
  }

  const SectionRequest& request_;
  double x_, y_, width_, height_;
  bool reaches_x_ = false, reaches_y_ = false;
};

// Element i of van der Corput's sequence in this base.
double spread(int i, int base) {
  double result = 0.0;
  double weight = 1.0 / base;
  for (; i > 0; i /= base, weight /= base) result += weight * (i % base);
  return result;
}

// Where H is least: where its slope vanishes, by two slopes where it is a square, near there else.
double least_momentum(EnergyOfMomentum& error, double size) {
  const double at_zero = error.slope(0.0);
  const double bend = (error.slope(size) - at_zero) / size;
  return bend > 0.0 ? -at_zero / bend : 0.0;
}

}  // namespace

double energy_of_momentum(const SectionRequest& request) {
  EnergyOfMomentum error(request, request.start.state);
  return std::max(0.0, -error(least_momentum(error, size_at(request, request.momentum))));
}

std::optional<State> with_energy(const SectionRequest& request, State state) {
  EnergyOfMomentum error(request, state);
  const double size = size_at(request, request.momentum);
  const double least = least_momentum(error, size);
  const double below = error(least);
  if (!(below <= 0.0)) return std::nullopt;
  for (const double side : {1.0, -1.0}) {
    double width = 1e-3 * std::max(size, std::abs(least));
    double value = error(least + side * width);
    for (int doubling = 0; doubling < 60 && value < 0.0; ++doubling) {
      width *= 2;
      value = error(least + side * width);
    }
    if (!(value >= 0.0) || !std::isfinite(value)) continue;
    const double far = least + side * width;
    std::uintmax_t iterations = 100;
    const auto root = boost::math::tools::toms748_solve(
        error, std::min(least, far), std::max(least, far), side > 0 ? below : value,
        side > 0 ? value : below, boost::math::tools::eps_tolerance<double>(53), iterations);
    state[request.momentum] = {
        std::abs(error(root.first)) < std::abs(error(root.second)) ? root.first : root.second, 0.0};
    if (goes_the_right_way(request, state)) return state;
  }
  return std::nullopt;
}

SectionStarts section_starts(const SectionRequest& request) {
  SectionStarts starts;
  if (request.orbits == 0) {
    starts.states.push_back(request.start.state);
    return starts;
  }
  const double x = request.start.state[request.first].hi;
  const double y = request.start.state[request.second].hi;
  const std::array<double, 4> box = request.box ? *request.box : Region(request, x, y).rectangle();
  constexpr int kTriesForOne = 50;
  for (int i = 1; static_cast<int>(starts.states.size()) < request.orbits &&
                  starts.tried < kTriesForOne * request.orbits && !is_stopped(request.stop);
       ++i) {
    ++starts.tried;
    State state = request.start.state;
    state[request.first] = {box[0] + (box[1] - box[0]) * spread(i, 2), 0.0};
    state[request.second] = {box[2] + (box[3] - box[2]) * spread(i, 3), 0.0};
    if (request.fixed) state[request.fixed->first] = {request.fixed->second, 0.0};
    if (auto found = with_energy(request, std::move(state))) {
      starts.states.push_back(std::move(*found));
    } else {
      ++starts.unreachable;
    }
  }
  if (starts.states.empty() && !is_stopped(request.stop))
    throw UsageError(fmt::format(
        "no momentum reaches H = {:.10g} from any of {} starting points of the section\nhelp: "
        "another --energy, or a rectangle of starting points around one that has it: --from",
        request.energy, starts.tried));
  return starts;
}

}  // namespace hamgen::app
