// Figures 7 and 8: the best pair for several steps, the linear law, and the order.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/paper/study.hpp"

namespace hamgen::paper {
namespace {

constexpr long double kAngleOfFigure7 = 3.1L;
constexpr double kTwoPeriods = 243.0;

struct Tuned {
  long double h = 0.0L;
  Pair pair;

  [[nodiscard]] long double b() const { return pair.beta / h; }
  [[nodiscard]] long double c() const { return pair.gamma / h; }
};

std::vector<Tuned> search(const Study& study) {
  std::vector<Tuned> found = {{0.05L}, {0.1L}, {0.2L}, {0.5L}, {1.0L}};
  if (study.quick) found.erase(found.begin());
  in_parallel(static_cast<int>(found.size()), [&](int i) {
    Tuned& tuned = found[static_cast<std::size_t>(i)];
    tuned.pair = best_pair(study.extended, kAngleOfFigure7, tuned.h, study.quick ? 500 : 2000);
  });
  return found;
}

// At h = 0 of the least squares fit y = y0 + y2 h^2.
long double limit(const std::vector<Tuned>& tuned, long double (Tuned::*value)() const) {
  long double x_mean = 0.0L;
  long double y_mean = 0.0L;
  for (const Tuned& t : tuned) {
    x_mean += t.h * t.h / static_cast<long double>(tuned.size());
    y_mean += (t.*value)() / static_cast<long double>(tuned.size());
  }
  long double xx = 0.0L;
  long double xy = 0.0L;
  for (const Tuned& t : tuned) {
    const long double x = t.h * t.h - x_mean;
    xx += x * x;
    xy += x * ((t.*value)() - y_mean);
  }
  return y_mean - xy / xx * x_mean;
}

double spread(const CompiledScheme& scheme, long double h, const Gauge& gauge = {}) {
  return integrate(scheme, {.q = kAngleOfFigure7, .h = h, .gauge = gauge},
                   static_cast<long>(kTwoPeriods / static_cast<double>(h)))
      .spread();
}

// Column names, then one row of spreads for each h, methods in the columns' order.
struct Spreads {
  std::vector<std::string> names;
  std::vector<long double> h;
  std::vector<std::vector<double>> values;
};

Spreads measure_spreads(const Study& study, const std::vector<Tuned>& tuned) {
  Spreads result{.names = {"midpoint rule", "the paper's b h, c h", "-h E/12, -h/12", "best pair"}};
  for (const auto* group : {&study.splittings, &study.orders}) {
    for (const CompiledScheme& scheme : *group) result.names.push_back(scheme.name);
  }
  result.h = {0.007L};
  for (const Tuned& t : tuned) result.h.push_back(t.h);
  result.values.resize(result.h.size());
  in_parallel(static_cast<int>(result.h.size()), [&](int i) {
    const long double h = result.h[static_cast<std::size_t>(i)];
    std::vector<double>& row = result.values[static_cast<std::size_t>(i)];
    row = {spread(study.extended, h), spread(study.extended, h, paper_pair(h)),
           spread(study.extended, h, gauge_of(analytic_pair(kAngleOfFigure7, h)))};
    // No search for h = 0.007: that is where the law is tried.
    row.push_back(
        i == 0 ? NAN
               : spread(study.extended, h, gauge_of(tuned[static_cast<std::size_t>(i - 1)].pair)));
    for (const auto* group : {&study.splittings, &study.orders}) {
      for (const CompiledScheme& scheme : *group) row.push_back(spread(scheme, h));
    }
  });
  return result;
}

void write_figures_7_and_8(const Study& study, const std::vector<Tuned>& tuned,
                           const Spreads& spreads) {
  DataTable law;
  law.block("h beta gamma");
  for (const Tuned& t : tuned) law.row({t.h, t.pair.beta, t.pair.gamma});
  law.write(study.data / "figure_8_law.dat");
  DataTable order;
  for (std::size_t k = 0; k < spreads.names.size(); ++k) {
    order.block(spreads.names[k]);
    for (std::size_t i = 0; i < spreads.h.size(); ++i) {
      if (std::isfinite(spreads.values[i][k])) order.row({spreads.h[i], spreads.values[i][k]});
    }
  }
  order.write(study.data / "figure_8_order.dat");
  for (const long double h : spreads.h) {
    DataTable data;
    const auto steps = static_cast<long>(kTwoPeriods / 2 / static_cast<double>(h));
    const auto add = [&](const std::string& name, const CompiledScheme& scheme,
                         const Gauge& gauge = {}) {
      trace(data, name, scheme, {.q = kAngleOfFigure7, .h = h, .gauge = gauge}, steps, 600);
    };
    add("midpoint rule", study.extended);
    add("the paper's beta = b h, gamma = c h", study.extended, paper_pair(h));
    add("beta = -h E/12, gamma = -h/12", study.extended,
        gauge_of(analytic_pair(kAngleOfFigure7, h)));
    for (const auto* group : {&study.splittings, &study.orders}) {
      for (const CompiledScheme& scheme : *group) add(scheme.name, scheme);
    }
    data.write(study.data / fmt::format("figure_7_{:g}.dat", static_cast<double>(h)));
  }
}

// Of the energy error between the two smallest steps that were searched.
double order_of(const Spreads& spreads, std::size_t column) {
  return std::log(spreads.values[2][column] / spreads.values[1][column]) /
         std::log(static_cast<double>(spreads.h[2] / spreads.h[1]));
}

struct StateErrors {
  Table table;
  std::vector<double> order;   // of the state error at q = 3.1, method by method
  std::vector<double> coarse;  // with h = 0.1
};

// At t = 100 with h = 0.1, and what halving h does.
StateErrors state_errors(const Study& study) {
  StateErrors result{.table = {.header = {"state error at t = 100, h = 0.1", "q(0) = 3.1",
                                          "its order", "q(0) = 0.8", "spread, q(0) = 0.8"}}};
  const State exact_31 = exact_state(study.reference, kAngleOfFigure7, 100.0L);
  const State exact_08 = exact_state(study.reference, 0.8L, 100.0L);
  const auto add = [&](const std::string& name, const CompiledScheme& scheme, const auto& gauge) {
    const auto orbit = [&](long double q, long double h, long steps) {
      return integrate(scheme, {.q = q, .h = h, .gauge = gauge(h)}, steps);
    };
    const double coarse = distance(orbit(kAngleOfFigure7, 0.1L, 1000).end, exact_31);
    const double fine = distance(orbit(kAngleOfFigure7, 0.05L, 2000).end, exact_31);
    const Orbit other = orbit(0.8L, 0.1L, 1000);
    result.order.push_back(std::log2(coarse / fine));
    result.coarse.push_back(coarse);
    result.table.rows.push_back({name, number(coarse),
                                 order_text({0.05, 0.1}, {fine, coarse}, kStateFloor),
                                 number(distance(other.end, exact_08)), number(other.spread())});
  };
  const auto none = [](long double) { return Gauge{}; };
  add("midpoint rule", study.extended, none);
  add("the paper's b h, c h", study.extended, paper_pair);
  for (const auto* group : {&study.splittings, &study.orders}) {
    for (const CompiledScheme& scheme : *group) add(scheme.name, scheme, none);
  }
  return result;
}

}  // namespace

Section figures_7_and_8(const Study& study) {
  const std::vector<Tuned> tuned = search(study);
  const Spreads spreads = measure_spreads(study, tuned);
  write_figures_7_and_8(study, tuned, spreads);
  const long double b = limit(tuned, &Tuned::b);
  const long double c = limit(tuned, &Tuned::c);
  const long double exact_b = -hamiltonian(kAngleOfFigure7, 0.0L) / 12;
  const long double exact_c = -1.0L / 12;
  const Tuned& at_01 = *std::ranges::find(tuned, 0.1L, &Tuned::h);
  double bend = 0.0;
  for (const Tuned& t : tuned) {
    bend = std::max({bend, static_cast<double>(std::fabs(t.b() / exact_b - 1)),
                     static_cast<double>(std::fabs(t.c() / exact_c - 1))});
  }

  Table law{.header = {"h", "beta / h", "gamma / h", "spread"}};
  for (std::size_t i = 0; i < tuned.size(); ++i) {
    law.rows.push_back({fmt::format("{:g}", static_cast<double>(tuned[i].h)),
                        number(tuned[i].b(), 9), number(tuned[i].c(), 9),
                        number(spreads.values[i + 1][3])});
  }
  law.rows.push_back({"towards 0", number(b, 9), number(c, 9), ""});
  law.rows.push_back({"closed form", number(exact_b, 9), number(exact_c, 9), ""});
  law.rows.push_back({"the paper", number(kPaperB, 9), number(kPaperC, 9), ""});

  Table orders{.header = {"spread, q(0) = 3.1, two periods"}};
  for (const long double h : spreads.h)
    orders.header.push_back(fmt::format("h = {:g}", static_cast<double>(h)));
  orders.header.push_back("order");
  for (std::size_t k = 0; k < spreads.names.size(); ++k) {
    orders.rows.push_back({spreads.names[k]});
    for (const std::vector<double>& row : spreads.values)
      orders.rows.back().push_back(number(row[k]));
    std::vector<double> h;  // those that were searched
    std::vector<double> errors;
    for (std::size_t i = 1; i < spreads.h.size(); ++i) {
      h.push_back(static_cast<double>(spreads.h[i]));
      errors.push_back(spreads.values[i][k]);
    }
    // The paper's constants are best for one step: no power of h.
    orders.rows.back().push_back(k == 1 ? "-" : order_text(h, errors, kEnergyFloor));
  }
  const StateErrors states = state_errors(study);
  const double law_order = order_of(spreads, 2);
  const double best_order = order_of(spreads, 3);
  const std::vector<double>& smallest = spreads.values[0];

  Section section{
      .title = "Figures 7 and 8: the linear law and the order",
      .picture = "figure_7.png",
      .caption =
          "Figure 7: abs(H - H(0)) over one period, q(0) = 3.1, for several steps; h = 0.007 "
          "with extrapolated parameters."};
  section.claims = {
      {"Fig. 7, 8, 4.1.3", "The best beta and gamma are proportional to h",
       fmt::format("for h up to {:g}, beta/h and gamma/h are constant to {:.1e} of themselves",
                   static_cast<double>(tuned.back().h), bend),
       verdict(bend < 2e-3)},
      {"4.1.3", "b = -2.4978136594e-3, c = -8.33321735568e-2",
       fmt::format(
           "at h = 0.1: b = {}, c = {}; towards h = 0: {} and {}, the closed form's -E/12 and "
           "-1/12 to {:.1e} and {:.1e} of themselves",
           number(at_01.b(), 9), number(at_01.c(), 9), number(b, 9), number(c, 9),
           static_cast<double>(std::fabs(b / exact_b - 1)),
           static_cast<double>(std::fabs(c / exact_c - 1))),
       verdict(std::fabs(at_01.b() / kPaperB - 1) < 1e-5L &&
               std::fabs(at_01.c() / kPaperC - 1) < 1e-5L)},
      {"Fig. 7", "Parameters extrapolated to h = 0.007 give a flat energy",
       fmt::format(
           "spread {} with the paper's b and c, {} with the closed form; the midpoint rule has {}",
           number(smallest[1]), number(smallest[2]), number(smallest[0])),
       verdict(smallest[1] < 1e-3 * smallest[0])},
      {"Fig. 8", "The best pairs raise the order to four",
       fmt::format(
           "observed order of the energy error: {:.2f} with the best pairs, {:.2f} with the "
           "closed form, {:.2f} for the midpoint rule. The order of the state error with the "
           "linear law is {:.2f} (last table)",
           best_order, law_order, order_of(spreads, 0), states.order[1]),
       verdict(std::fabs(best_order - 4) < 0.1 && states.order[1] > 3.9,
               std::fabs(best_order - 4) < 0.1)},
      {"4.1.3, 5 i", "Gauge parameters control the energy (and any other) integral",
       fmt::format(
           "the energy they do (above). The pendulum has no other integral that does not depend "
           "on time: all are functions of H. The one that does, t less the time the orbit takes to "
           "(q, p), is that of the phase, and the paper's pair loses it faster: state error {} at "
           "t = 100 with h = 0.1, the midpoint rule has {}",
           number(states.coarse[1]), number(states.coarse[0])),
       verdict(states.coarse[1] < 0.1 * states.coarse[0], true)}};
  section.body = {
      "![Figure 8](figure_8.png)\n\n*Figure 8. Left: the best pairs and the lines -h E/12, -h/12. "
      "Right: spread of the energy error against h; dotted h^2 and h^4.*",
      to_markdown(law), to_markdown(orders),
      "What the pair costs: it is right for one energy, and it moves along the orbit at another "
      "speed. Errors of the state, and the same pair at another amplitude:",
      to_markdown(states.table)};
  section.numbers = {{"b_limit", static_cast<double>(b)},
                     {"c_limit", static_cast<double>(c)},
                     {"b_at_01", static_cast<double>(at_01.b())},
                     {"c_at_01", static_cast<double>(at_01.c())},
                     {"midpoint_energy_order", order_of(spreads, 0)},
                     {"tuned_energy_order", best_order},
                     {"tuned_state_order", states.order[1]}};
  return section;
}

}  // namespace hamgen::paper
