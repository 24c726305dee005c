// Figure 2: the energy error for alpha from 0 to 1/2.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmarks/paper/study.hpp"

namespace hamgen::paper {
namespace {

constexpr long double kStepOfFigure2 = 0.1L;  // the caption does not say
constexpr std::array<long double, 2> kAngles = {0.8L, 3.1L};

// beta = gamma = sqrt(alpha (1 - alpha)), the paper's symplectic rotation, or 0.
Gauge gauge_of(int tenths, bool rotation) {
  const long double alpha = tenths / 10.0L;
  const long double rotated = rotation ? std::sqrt(alpha * (1 - alpha)) : 0.0L;
  return {.alpha = alpha, .beta = rotated, .gamma = rotated};
}

void write_figure_2(const Study& study) {
  DataTable data;
  for (const bool rotation : {true, false}) {
    for (const long double q : kAngles) {
      const long steps = q < 1 ? 800 : 2500;  // about two periods
      for (int tenths = 0; tenths <= 5; ++tenths) {
        trace(data, fmt::format("alpha = 0.{}", tenths), study.member,
              {.q = q, .h = kStepOfFigure2, .gauge = gauge_of(tenths, rotation)}, steps, 800);
      }
    }
  }
  data.write(study.data / "figure_2.dat");
}

// The largest distance of two methods' states over 1000 steps.
double difference(const CompiledScheme& a, const Gauge& gauge, const CompiledScheme& b) {
  std::vector<State> states;
  static_cast<void>(integrate(a, {.q = 3.1L, .h = kStepOfFigure2, .gauge = gauge}, 1000,
                              [&](const Sample& sample) { states.push_back(sample.state); }));
  double largest = 0.0;
  std::size_t i = 0;
  static_cast<void>(integrate(b, {.q = 3.1L, .h = kStepOfFigure2}, 1000, [&](const Sample& sample) {
    largest = std::max(largest, distance(sample.state, states[i++]));
  }));
  return largest;
}

}  // namespace

Section figure_2(const Study& study) {
  write_figure_2(study);
  // [rotation or not][angle][alpha from 0 to 1 by tenths]
  using Spreads = std::array<std::array<std::array<double, 11>, 2>, 2>;
  Spreads spread{};
  Spreads by_sweeps{};
  Spreads early{};  // of the first half of the steps
  Spreads early_by_sweeps{};
  in_parallel(44, [&](int i) {
    const std::size_t row = i / 22;
    const std::size_t angle = i / 11 % 2;
    const std::size_t tenths = i % 11;
    const Start start{.q = kAngles[angle],
                      .h = kStepOfFigure2,
                      .gauge = gauge_of(static_cast<int>(tenths), row == 0)};
    spread[row][angle][tenths] = integrate(study.member, start, study.steps()).spread();
    by_sweeps[row][angle][tenths] = integrate(study.sweeps, start, study.steps()).spread();
    early[row][angle][tenths] = integrate(study.member, start, study.steps() / 2).spread();
    early_by_sweeps[row][angle][tenths] =
        integrate(study.sweeps, start, study.steps() / 2).spread();
  });
  double growth = 0.0;
  double sweeps_differ = 0.0;
  double sweeps_differ_early = 0.0;
  for (std::size_t i = 0; i < 44; ++i) {
    const auto at = [i](const Spreads& values) { return values[i / 22][i / 11 % 2][i % 11]; };
    growth = std::max(growth, at(spread) / at(early));
    sweeps_differ = std::max(sweeps_differ, std::fabs(at(by_sweeps) / at(spread) - 1));
    sweeps_differ_early =
        std::max(sweeps_differ_early, std::fabs(at(early_by_sweeps) / at(early) - 1));
  }
  const auto ratio = [&spread](std::size_t angle) {
    const auto [least, most] = std::ranges::minmax(spread[0][angle]);
    return most / least;
  };
  const double same_order = std::max(ratio(0), ratio(1));
  const double larger =
      std::min(spread[0][0][5] / spread[1][0][5], spread[0][1][5] / spread[1][1][5]);
  const double to_a = difference(study.member, {.alpha = 0.0L}, study.euler_a);
  const double to_b = difference(study.member, {.alpha = 1.0L}, study.euler_b);

  Section section{
      .title = "Figure 2: alpha from 0 to 1/2",
      .picture = "figure_2.png",
      .caption =
          "Energy error H - H(0), h = 0.1 (the paper gives no h here). Left q(0) = 0.8, right "
          "q(0) = 3.1. Above beta = gamma = sqrt(alpha (1 - alpha)), below beta = gamma = 0."};
  section.claims = {
      {"4.1.1 a", "alpha from 0 to 1 connects the symplectic Euler methods A and B",
       fmt::format(
           "alpha = 0 and 1 are their steps to within {:.1e} and {:.1e} after 1000 steps; the "
           "spread between them changes smoothly (table)",
           to_a, to_b),
       verdict(to_a < 1e-12 && to_b < 1e-12)},
      {"4.1.1 a", "The energy is well conserved, it oscillates",
       fmt::format("{} steps have a spread at most {:.3f} times that of the first half: no drift",
                   study.steps(), growth),
       verdict(growth < 1.1)},
      {"4.1.1 a",
       "With beta = gamma = sqrt(alpha (1 - alpha)) the oscillations are of the same order "
       "of magnitude for every member",
       fmt::format("largest spread / smallest over alpha = 0, 0.1, ..., 1: {:.1f} at q(0) = 0.8, "
                   "{:.1f} at 3.1",
                   ratio(0), ratio(1)),
       verdict(same_order < 10, same_order < 100)},
      {"4.1.1 a, Fig. 2", "(0.5, 0.5, 0.5) oscillates much more than (0.5, 0, 0)",
       fmt::format("{:.0f} times at q(0) = 0.8, {:.0f} times at 3.1",
                   spread[0][0][5] / spread[1][0][5], spread[0][1][5] / spread[1][1][5]),
       verdict(larger > 100)},
      {"3.1, 4.1.1", "Values close to (0.5, 0, 0) have very small error",
       fmt::format(
           "beta = gamma = 0: the spread at alpha = 0.4 is {:.0f} times that at 0.5 for q(0) = "
           "0.8, {:.0f} times for 3.1",
           spread[1][0][4] / spread[1][0][5], spread[1][1][4] / spread[1][1][5]),
       verdict(spread[1][0][4] > 10 * spread[1][0][5] && spread[1][1][4] > 10 * spread[1][1][5])}};

  Table table{.header = {"spread max H - min H", "rotation, q(0) = 0.8", "rotation, 3.1",
                         "beta = gamma = 0, 0.8", "beta = gamma = 0, 3.1"}};
  for (std::size_t i = 0; i < 11; ++i) {
    table.rows.push_back({fmt::format("alpha = {:.1f}", static_cast<double>(i) / 10),
                          number(spread[0][0][i]), number(spread[0][1][i]), number(spread[1][0][i]),
                          number(spread[1][1][i])});
  }
  for (const CompiledScheme& scheme : study.orders) {
    const auto text = [&](long double q) {
      return number(integrate(scheme, {.q = q, .h = kStepOfFigure2}, study.steps()).spread());
    };
    table.rows.push_back({scheme.name, "", "", text(0.8L), text(3.1L)});
  }
  section.body = {
      fmt::format("Over {} steps, solved to round-off. Algorithm 1 with kappa = 5 gives the same "
                  "spreads to {:.1e} of themselves, to {:.1e} over half as many: what it leaves "
                  "unsolved adds up.",
                  study.steps(), sweeps_differ, sweeps_differ_early),
      to_markdown(table)};
  section.numbers = {{"midpoint_spread", spread[1][1][5]}, {"euler_a_difference", to_a}};
  return section;
}

}  // namespace hamgen::paper
