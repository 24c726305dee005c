// Figure 5: what beta and gamma do to the energy error of an orbit near the separatrix.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "benchmarks/paper/study.hpp"

namespace hamgen::paper {
namespace {

constexpr long double kAngleOfFigure5 = 3.1L;
constexpr long double kStepOfFigure5 = 0.1L;
constexpr long kHalfPeriod = 607;  // steps; the period is 121.47
constexpr long double kFixedGamma = -0.007L;

Start start_of(long double beta, long double gamma) {
  return {.q = kAngleOfFigure5,
          .h = kStepOfFigure5,
          .gauge = {.alpha = 0.5L, .beta = beta, .gamma = gamma}};
}

// The energy error where the pendulum first passes q = angle, between steps linear.
long double error_at(const Study& study, const Start& start, long double angle) {
  std::optional<Sample> before;
  std::optional<long double> error;
  static_cast<void>(integrate(study.extended, start, kHalfPeriod, [&](const Sample& sample) {
    if (!error && before && before->state.q >= angle && sample.state.q < angle) {
      const long double part = (before->state.q - angle) / (before->state.q - sample.state.q);
      error = before->error + part * (sample.error - before->error);
    }
    before = sample;
  }));
  return error.value_or(NAN);
}

// Local extrema of the energy error inside a half period.
int extrema(const CompiledScheme& scheme) {
  std::vector<long double> errors;
  static_cast<void>(integrate(scheme, {.q = kAngleOfFigure5, .h = kStepOfFigure5}, kHalfPeriod,
                              [&](const Sample& sample) { errors.push_back(sample.error); }));
  int count = 0;
  for (std::size_t i = 2; i < errors.size(); ++i)
    count += (errors[i] - errors[i - 1]) * (errors[i - 1] - errors[i - 2]) < 0 ? 1 : 0;
  return count;
}

long double largest_error(const CompiledScheme& scheme, const Start& start) {
  long double largest = 0;
  static_cast<void>(integrate(scheme, start, kHalfPeriod, [&](const Sample& sample) {
    largest = std::max(largest, std::fabs(sample.error));
  }));
  return largest;
}

// The members of higher order beside the midpoint rule and its best pair.
Table table_of_orders(const Study& study, const Pair& best) {
  Table table{.header = {"over half a period", "largest error"}};
  const auto add = [&](const std::string& name, const CompiledScheme& scheme, const Start& start) {
    table.rows.push_back({name, number(largest_error(scheme, start))});
  };
  add("midpoint rule", study.extended, start_of(0, 0));
  add("beta = -h E/12, gamma = -h/12", study.extended, start_of(best.beta, best.gamma));
  for (const CompiledScheme& scheme : study.orders)
    add(scheme.name, scheme, {.q = kAngleOfFigure5, .h = kStepOfFigure5});
  return table;
}

void write_figure_5(const Study& study, const Pair& best) {
  DataTable data;
  const auto add = [&](long double beta, long double gamma, const std::string& title) {
    trace(data, title, study.extended, start_of(beta, gamma), kHalfPeriod, kHalfPeriod);
  };
  for (int i = 0; i <= 4; ++i) {
    const long double beta = -i * 1e-4L;
    add(beta, kFixedGamma, fmt::format("{:g}", static_cast<double>(beta)));
  }
  for (const long double gamma : {-0.005L, -0.007L, -0.00833321735568L, -0.01L, -0.012L})
    add(best.beta, gamma, fmt::format("{:.3g}", static_cast<double>(gamma)));
  add(kPaperB * kStepOfFigure5, kPaperC * kStepOfFigure5, "the paper's pair");
  trace(data, "midpoint", study.extended, {.q = kAngleOfFigure5, .h = kStepOfFigure5}, kHalfPeriod,
        kHalfPeriod);
  for (const CompiledScheme& scheme : study.splittings)
    trace(data, scheme.name, scheme, {.q = kAngleOfFigure5, .h = kStepOfFigure5}, kHalfPeriod,
          kHalfPeriod);
  data.write(study.data / "figure_5.dat");
}

}  // namespace

Section figure_5(const Study& study) {
  const Pair analytic = analytic_pair(kAngleOfFigure5, kStepOfFigure5);
  write_figure_5(study, analytic);
  const long double bottom = 0.0L;
  const long double level = std::acos(-1.0L) / 2;  // cos q = 0
  Table table{.header = {"beta", "gamma", "at q = 0", "formula", "at q = pi/2", "formula"}};
  double off = 0.0;
  const auto add = [&](long double beta, long double gamma) {
    const Start start = start_of(beta, gamma);
    const std::array values = {error_at(study, start, bottom), predicted_error(1.0L, start),
                               error_at(study, start, level), predicted_error(0.0L, start)};
    table.rows.push_back({fmt::format("{:g}", static_cast<double>(beta)),
                          fmt::format("{:g}", static_cast<double>(gamma)), number(values[0]),
                          number(values[1]), number(values[2]), number(values[3])});
    const long double size = std::fabs(values[1]) + std::fabs(values[3]);
    off = std::max(
        off, static_cast<double>(
                 (std::fabs(values[0] - values[1]) + std::fabs(values[2] - values[3])) / size));
    return values;
  };
  const auto one = add(0.0L, kFixedGamma);
  const auto other = add(-4e-4L, kFixedGamma);
  const auto low = add(-1e-4L, -0.002L);
  const auto high = add(-1e-4L, -0.012L);
  // d error / d parameter at the bottom and at pi/2.
  const long double beta_bottom = (one[0] - other[0]) / 4e-4L;
  const long double beta_level = (one[2] - other[2]) / 4e-4L;
  const long double gamma_bottom = (low[0] - high[0]) / 0.01L;
  const long double gamma_level = (low[2] - high[2]) / 0.01L;

  Section section{
      .title = "Figure 5: beta and the central cusp, gamma and the others",
      .picture = "figure_5.png",
      .caption =
          "Energy error over half a period, q(0) = 3.1, h = 0.1. Above left: beta with gamma = "
          "-0.007 (the paper prints -00.7). Above right: gamma with beta = -h E/12. Below: the "
          "tuned pair among other methods, linear and logarithmic."};
  section.claims = {
      {"Fig. 5, 4.1.2 b", "beta controls the central cusp",
       fmt::format("at q = 0 the error changes by {} per unit of beta, and by {} per unit of gamma",
                   number(beta_bottom), number(gamma_bottom)),
       verdict(std::fabs(beta_bottom) > 1000 * std::fabs(gamma_bottom))},
      {"Fig. 5, 4.1.2 b", "gamma controls the two surrounding cusps",
       fmt::format(
           "at q = pi/2 gamma moves the error {:.0f} times as much as at q = 0; beta moves it "
           "there too, {:.2f} times as much as at q = 0",
           static_cast<double>(std::fabs(gamma_level / gamma_bottom)),
           static_cast<double>(std::fabs(beta_level / beta_bottom))),
       verdict(std::fabs(gamma_level) > 100 * std::fabs(gamma_bottom))}};
  int three = 0;
  std::string counts = fmt::format("midpoint rule {}", extrema(study.extended));
  for (const CompiledScheme& scheme : study.splittings) {
    const int count = extrema(scheme);
    three += count == 3 ? 1 : 0;
    counts += fmt::format(", {} {}", scheme.name, count);
  }
  section.claims.insert(
      section.claims.begin(),
      {"4.1.2 b", "In an oscillation of a symmetric method, for instance SABA2, three cusps arise",
       fmt::format(
           "extrema of the error inside half a period: {}. By the formula below there are three "
           "if beta/h + E/12 is small beside eps (gamma/h + 1/12), else one",
           counts),
       verdict(three == static_cast<int>(study.splittings.size()) && extrema(study.extended) == 3,
               three > 0)});
  section.body = {
      fmt::format(
          "Why: with c = cos q, c0 = cos q(0) and E = -eps c0,\n\n"
          "    H - H(0) = h^2 [ eps^2 (gamma/(2h) + 1/24) (c^2 - c0^2) + eps (beta/h + E/12) "
          "(c - c0) ] + O(h^4).\n\n"
          "Near the separatrix c0^2 is almost 1, so that at the bottom, c = 1, the first term "
          "vanishes whatever gamma is: the central cusp is beta's. Both vanish everywhere for\n\n"
          "    gamma = -h/12,   beta = -h E/12,\n\n"
          "here {} and {}. The formula and the measured errors, at most {:.1e} of each other "
          "apart:",
          number(analytic.gamma, 6), number(analytic.beta, 6), off),
      to_markdown(table),
      "The members of order 4, 6 and 8 have no h^2 term for beta and gamma to control; what is "
      "left of "
      "the error, in long double:",
      to_markdown(table_of_orders(study, analytic))};
  section.numbers = {{"formula_off", off},
                     {"gamma_cusp_ratio", static_cast<double>(gamma_level / gamma_bottom)}};
  return section;
}

}  // namespace hamgen::paper
