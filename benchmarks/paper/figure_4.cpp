// Figure 4: beta = gamma with alpha = 1/2, and the comparison with SABA2.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include "benchmarks/paper/study.hpp"

namespace hamgen::paper {
namespace {

constexpr long double kAngleOfFigure4 = 0.8L;
constexpr long double kStepOfFigure4 = 0.2L;
constexpr long double kPaperValue = -3.4e-5L;

Gauge equal(long double value) { return {.alpha = 0.5L, .beta = value, .gamma = value}; }

struct Line {
  std::string name;
  const CompiledScheme* scheme;
  Gauge gauge = {};
};

std::vector<Line> lines_of_order_plot(const Study& study) {
  std::vector<Line> lines = {{"(1/2, 0, 0)", &study.extended},
                             {"(0.3, 0, 0)", &study.extended, {.alpha = 0.3L}},
                             {"(1/2, 1/2, 1/2)", &study.extended, equal(0.5L)},
                             {"(0.1, 0.3, 0.3)", &study.extended, {0.1L, 0.3L, 0.3L}}};
  for (const CompiledScheme& scheme : study.splittings) lines.push_back({scheme.name, &scheme});
  for (const CompiledScheme& scheme : study.orders) lines.push_back({scheme.name, &scheme});
  return lines;
}

struct Errors {
  double spread = 0.0;
  double state = 0.0;
};

constexpr int kRefinements = 6;
constexpr long double kTimeOfFigure4 = 100.0L;

// [line][refinement]: h = 1, 1/2, ..., 1/32.
std::vector<std::array<Errors, kRefinements>> errors_of(const Study& study,
                                                        const std::vector<Line>& lines) {
  const State exact = exact_state(study.reference, kAngleOfFigure4, kTimeOfFigure4);
  std::vector<std::array<Errors, kRefinements>> errors(lines.size());
  in_parallel(static_cast<int>(lines.size()) * kRefinements, [&](int i) {
    const Line& line = lines[static_cast<std::size_t>(i / kRefinements)];
    const int refinement = i % kRefinements;
    const Orbit orbit =
        integrate(*line.scheme,
                  {.q = kAngleOfFigure4, .h = std::ldexp(1.0L, -refinement), .gauge = line.gauge},
                  100L << refinement);
    errors[static_cast<std::size_t>(i / kRefinements)][static_cast<std::size_t>(refinement)] = {
        .spread = orbit.spread(), .state = distance(orbit.end, exact)};
  });
  return errors;
}

// Between the two smallest steps, each half of the one before.
double slope(double coarse, double fine) { return std::log2(coarse / fine); }

double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Nanoseconds a step; nine samples, sorted.
std::array<double, 9> step_times(const CompiledScheme& scheme, long steps) {
  std::array<double, 9> samples{};
  for (double& sample : samples) {
    runtime::Integrator integrator(
        scheme.library,
        {.parameters = {{.hi = 0.03}}, .h = {.hi = 0.2}, .state = {{.hi = 0.8}, {}}});
    const double begin = processor_seconds();
    static_cast<void>(integrator.advance(steps, false));
    sample = 1e9 * (processor_seconds() - begin) / static_cast<double>(steps);
  }
  std::ranges::sort(samples);
  return samples;
}

void write_figure_4(const Study& study, const std::vector<Line>& lines,
                    const std::vector<std::array<Errors, kRefinements>>& errors, long double best) {
  DataTable sweep;
  for (const long double value : {-0.5L, -0.25L, 0.0L, 0.25L, 0.5L}) {
    trace(sweep, fmt::format("{:.4g}", static_cast<double>(value)), study.extended,
          {.q = kAngleOfFigure4, .h = kStepOfFigure4, .gauge = equal(value)}, 400, 400);
  }
  sweep.write(study.data / "figure_4_sweep.dat");
  DataTable small;
  for (const long double value : {0.0L, kPaperValue, best}) {
    trace(small, fmt::format("{:.3g}", static_cast<double>(value)), study.extended,
          {.q = kAngleOfFigure4, .h = kStepOfFigure4, .gauge = equal(value)}, 400, 400);
  }
  small.write(study.data / "figure_4_small.dat");
  DataTable others;
  trace(others, "midpoint", study.extended, {.q = kAngleOfFigure4, .h = kStepOfFigure4}, 400, 400);
  for (const CompiledScheme& scheme : study.splittings)
    trace(others, scheme.name, scheme, {.q = kAngleOfFigure4, .h = kStepOfFigure4}, 400, 400);
  others.write(study.data / "figure_4_splittings.dat");
  DataTable order;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    order.block(lines[i].name);
    for (int k = 0; k < kRefinements; ++k) {
      const Errors& e = errors[i][static_cast<std::size_t>(k)];
      order.row({std::ldexp(1.0L, -k), e.spread, e.state});
    }
  }
  order.write(study.data / "figure_4_order.dat");
}

}  // namespace

Section figure_4(const Study& study) {
  const long steps = study.quick ? 2000 : 20'000;
  const auto spread = [&](const CompiledScheme& scheme, long double value, long double h) {
    return integrate(scheme, {.q = kAngleOfFigure4, .h = h, .gauge = equal(value)}, steps).spread();
  };
  const auto max_error = [&](const CompiledScheme& scheme, long double value, long double h) {
    return integrate(scheme, {.q = kAngleOfFigure4, .h = h, .gauge = equal(value)}, steps)
        .max_error();
  };
  // Where a measure of the error is least.
  const auto best_value = [&](const auto& measure, long double h) {
    return minimise([&](long double value) { return measure(study.extended, value, h); }, -1e-3L,
                    1e-3L, 1e-10L);
  };
  const long double best = best_value(spread, kStepOfFigure4);
  const double best_spread = spread(study.extended, best, kStepOfFigure4);
  const double paper_spread = spread(study.extended, kPaperValue, kStepOfFigure4);
  const double midpoint_spread = spread(study.extended, 0.0L, kStepOfFigure4);

  const std::vector<Line> lines = lines_of_order_plot(study);
  const auto errors = errors_of(study, lines);
  write_figure_4(study, lines, errors, best);

  const Orbit below = integrate(
      study.extended, {.q = kAngleOfFigure4, .h = kStepOfFigure4, .gauge = equal(-0.5L)}, steps);
  const Orbit above = integrate(
      study.extended, {.q = kAngleOfFigure4, .h = kStepOfFigure4, .gauge = equal(0.5L)}, steps);

  Table order{.header = {"", "order of the energy error", "order of the state error",
                         "spread at h = 1/8", "state error at h = 1/8, t = 100"}};
  std::vector<double> energy_order;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Errors& coarse = errors[i][kRefinements - 2];
    const Errors& fine = errors[i][kRefinements - 1];
    energy_order.push_back(slope(coarse.spread, fine.spread));
    std::vector<double> h;  // ascending
    std::vector<double> spreads;
    std::vector<double> states;
    for (int k = kRefinements; k-- > 0;) {
      h.push_back(std::ldexp(1.0, -k));
      spreads.push_back(errors[i][static_cast<std::size_t>(k)].spread);
      states.push_back(errors[i][static_cast<std::size_t>(k)].state);
    }
    order.rows.push_back({lines[i].name, order_text(h, spreads, kEnergyFloor),
                          order_text(h, states, kStateFloor), number(errors[i][3].spread),
                          number(errors[i][3].state)});
  }

  Section section{
      .title = "Figure 4: beta = gamma, and SABA2",
      .picture = "figure_4.png",
      .caption =
          "q(0) = 0.8, h = 0.2. Above: beta = gamma from -1/2 to 1/2; the midpoint rule and "
          "SABA2. Below: small beta = gamma; energy error against h, dotted h and h^2."};
  section.claims = {
      {"Fig. 4, 4.1.2 a",
       "From beta = gamma = -0.5 to 0.5 the amplitude goes from one sign to the "
       "other",
       fmt::format("the error lies in [{}, {}] at -0.5, in [{}, {}] at 0.5", number(below.min, 1),
                   number(below.max, 1), number(above.min, 1), number(above.max, 1)),
       verdict(std::fabs(below.max) < 0.01L * std::fabs(below.min) &&
               std::fabs(above.min) < 0.01L * std::fabs(above.max))},
      {"Fig. 4, below left", "The oscillation is least at beta = gamma = -3.4e-5",
       fmt::format(
           "the spread is least at {:.3e}: {}; at -3.4e-5 it is {}, at 0 {}. The largest "
           "abs(H - H(0)) is least at {:.3e}. With h = 0.1 these two would be {:.3e} and {:.3e}",
           static_cast<double>(best), number(best_spread), number(paper_spread),
           number(midpoint_spread), static_cast<double>(best_value(max_error, kStepOfFigure4)),
           static_cast<double>(best_value(spread, 0.1L)),
           static_cast<double>(best_value(max_error, 0.1L))),
       verdict(std::fabs(paper_spread / best_spread - 1) < 0.05, paper_spread < midpoint_spread)},
      {"Fig. 4, below right", "Generic members have order 1",
       fmt::format("observed: (0.3, 0, 0) {:.2f}, (1/2, 1/2, 1/2) {:.2f}, (0.1, 0.3, 0.3) {:.2f}; "
                   "(1/2, 0, 0) {:.2f}",
                   energy_order[1], energy_order[2], energy_order[3], energy_order[0]),
       verdict(std::fabs(energy_order[1] - 1) < 0.05 && std::fabs(energy_order[2] - 1) < 0.05 &&
               std::fabs(energy_order[3] - 1) < 0.05)}};
  for (const CompiledScheme& scheme : study.splittings) {
    const auto ratio = [&](long double q) {
      return integrate(scheme, {.q = q, .h = kStepOfFigure4}, steps).spread() /
             integrate(study.sweeps, {.q = q, .h = kStepOfFigure4}, steps).spread();
    };
    std::string ratios;
    double least = 1e300;
    double most = 0.0;
    for (const long double q : {0.8L, 1.6L, 2.5L, 3.1L, 3.13L}) {
      const double value = ratio(q);
      least = std::min(least, value);
      most = std::max(most, value);
      ratios += fmt::format("{}{:.2f}", ratios.empty() ? "" : ", ", value);
    }
    section.claims.push_back(
        {"Fig. 4, 4.1.1",
         fmt::format("The midpoint rule with five iterations is more accurate than {}",
                     scheme.name),
         fmt::format(
             "{}'s spread of the energy error is that of the midpoint rule times {} for q(0) "
             "= 0.8, 1.6, 2.5, 3.1, 3.13",
             scheme.name, ratios),
         verdict(least > 1, most > 1)});
  }
  if (!study.timed.empty()) {
    const long timed_steps = study.quick ? 20'000 : 200'000;
    std::vector<std::array<double, 9>> times;
    Table cost{.header = {"q(0) = 0.8, h = 0.2, double", "ns/step, median", "quartiles"}};
    for (const CompiledScheme& scheme : study.timed) {
      times.push_back(step_times(scheme, timed_steps));
      const auto& t = times.back();
      cost.rows.push_back(
          {scheme.name, fmt::format("{:.0f}", t[4]), fmt::format("{:.0f} to {:.0f}", t[2], t[6])});
    }
    section.claims.push_back(
        {"4.1.1", "It is significantly more costly, because it is iterative",
         fmt::format(
             "five sweeps take {:.1f} times, the generated Newton step {:.1f} times as long as "
             "SABA2",
             times[0][4] / times[2][4], times[1][4] / times[2][4]),
         verdict(std::min(times[0][4], times[1][4]) > 1.5 * times[2][4],
                 times[0][4] > times[2][4])});
    section.body.push_back(to_markdown(cost));
  }
  section.body.insert(section.body.begin(), to_markdown(order));
  section.numbers = {{"midpoint_order", energy_order[0]},
                     {"generic_order", energy_order[1]},
                     {"best_equal", static_cast<double>(best)}};
  return section;
}

}  // namespace hamgen::paper
