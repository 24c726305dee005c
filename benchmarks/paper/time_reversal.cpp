// What 4.1.1 says of alpha, 1 - alpha and the direction of time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/paper/study.hpp"

namespace hamgen::paper {
namespace {

// Over one period of a moderate swing: near the separatrix the two members' periods, which differ
// by O(h) like everything else, would hide the comparison.
constexpr long double kAngleOfReversal = 0.8L;
constexpr long double kTimeOfReversal = 37.8L;

Gauge rotation(long double alpha) {
  const long double rotated = std::sqrt(alpha * (1 - alpha));
  return {.alpha = alpha, .beta = rotated, .gamma = rotated};
}

std::vector<long double> errors(const Study& study, const Gauge& gauge, long double h) {
  std::vector<long double> result;
  const auto steps =
      static_cast<long>(std::lround(std::fabs(static_cast<double>(kTimeOfReversal / h))));
  static_cast<void>(integrate(study.extended, {.q = kAngleOfReversal, .h = h, .gauge = gauge},
                              steps,
                              [&](const Sample& sample) { result.push_back(sample.error); }));
  return result;
}

// e = e(alpha, t) and f = e(1 - alpha, -t): the largest |e + f| and |e - f|, and how far the
// spreads of the two are apart, all in units of max |e|.
struct Asymmetry {
  double opposite = 0.0;
  double equal = 0.0;
  double spread = 0.0;
};

Asymmetry asymmetry(const Study& study, long double alpha, long double h) {
  const std::vector<long double> e = errors(study, rotation(alpha), h);
  const std::vector<long double> f = errors(study, rotation(1 - alpha), -h);
  long double most = 0.0L;
  long double sum = 0.0L;
  long double difference = 0.0L;
  for (std::size_t i = 0; i < e.size(); ++i) {
    most = std::max(most, std::fabs(e[i]));
    sum = std::max(sum, std::fabs(e[i] + f[i]));
    difference = std::max(difference, std::fabs(e[i] - f[i]));
  }
  const auto spread = [](const std::vector<long double>& values) {
    const auto [least, largest] = std::ranges::minmax(values);
    return largest - least;
  };
  return {.opposite = static_cast<double>(sum / most),
          .equal = static_cast<double>(difference / most),
          .spread = static_cast<double>(std::fabs(spread(e) - spread(f)) / most)};
}

// How far from its start the orbit ends after steps forward with one member, and back with another.
double return_distance(const Study& study, const CompiledScheme& scheme, const Gauge& there,
                       const Gauge& back) {
  const long steps = study.quick ? 1000 : 10'000;
  const Orbit out = integrate(scheme, {.q = kAngleOfReversal, .h = 0.1L, .gauge = there}, steps);
  const Orbit home = integrate_from(scheme, out.end, {.h = -0.1L, .gauge = back}, steps);
  return distance(home.end, {.q = kAngleOfReversal});
}

double return_distance(const Study& study, const Gauge& there, const Gauge& back) {
  return return_distance(study, study.extended, there, back);
}

void write_time_reversal(const Study& study) {
  DataTable data;
  for (const long double alpha : {0.3L, 0.7L}) {
    for (const long double h : {0.1L, -0.1L}) {
      trace(data, fmt::format("alpha = {:.1f}", static_cast<double>(alpha)), study.extended,
            {.q = 3.1L, .h = h, .gauge = rotation(alpha)}, 2500, 800);
    }
  }
  data.write(study.data / "time_reversal.dat");
}

}  // namespace

Section time_reversal(const Study& study) {
  write_time_reversal(study);
  Table table{.header = {"alpha", "h", "e(alpha, t) + e(1 - alpha, -t)",
                         "e(alpha, t) - e(1 - alpha, -t)", "difference of the spreads"}};
  std::vector<Asymmetry> found;
  for (const long double alpha : {0.1L, 0.3L}) {
    for (const long double h : {0.1L, 0.05L, 0.025L}) {
      found.push_back(asymmetry(study, alpha, h));
      table.rows.push_back({fmt::format("{:.1f}", static_cast<double>(alpha)),
                            fmt::format("{:.3f}", static_cast<double>(h)),
                            fmt::format("{:.1e}", found.back().opposite),
                            fmt::format("{:.1e}", found.back().equal),
                            fmt::format("{:.1e}", found.back().spread)});
    }
  }
  const Asymmetry& coarse = found[found.size() - 2];
  const Asymmetry& fine = found.back();
  const Gauge generic = rotation(0.3L);
  const Gauge adjoint = {.alpha = 0.7L, .beta = -generic.beta, .gamma = -generic.gamma};
  const double by_adjoint = return_distance(study, generic, adjoint);
  const double midpoint = return_distance(study, {}, {});
  const double half = return_distance(study, {0.5L, 0.5L, 0.5L}, {0.5L, 0.5L, 0.5L});
  const double tuned = return_distance(study, paper_pair(0.1L), paper_pair(-0.1L));

  std::string orders;
  for (const CompiledScheme& scheme : study.orders)
    orders += fmt::format("{}{:.1e} ({})", orders.empty() ? "" : ", ",
                          return_distance(study, scheme, {}, {}), scheme.name);

  Section section{.title = "Time reversal: alpha and 1 - alpha",
                  .picture = "time_reversal.png",
                  .caption =
                      "Energy error e(t) from q(0) = 3.1 forward and backward in time, h = 0.1, "
                      "beta = gamma = sqrt(alpha (1 - alpha))."};
  section.claims = {
      {"4.1.1",
       "With beta = gamma = sqrt(alpha (1 - alpha)), oscillations for (alpha, t) are "
       "symmetric with respect to those for (1 - alpha, -t)",
       fmt::format(
           "up to terms of higher order in h, and with the opposite sign: e(alpha, t) + "
           "e(1 - alpha, -t) is {:.1e} of e at h = 0.05 and {:.1e} at h = 0.025 for alpha = "
           "0.3",
           coarse.opposite, fine.opposite),
       verdict(fine.opposite < 1e-10, fine.opposite < 0.6 * coarse.opposite)},
      {"4.1.1",
       "alpha controls the symmetry of the oscillations in time; alpha = 0.5 is reversible",
       fmt::format("back and forth returns to {:.1e} with (1/2, 0, 0), to {:.1e} with beta = b h, "
                   "gamma = c h, but only to {:.1e} with (1/2, 1/2, 1/2)",
                   midpoint, tuned, half),
       verdict(midpoint < 1e-12 && tuned < 1e-12 && half < 1e-12,
               midpoint < 1e-12 && tuned < 1e-12)}};
  section.body = {
      "The largest values over one period at q(0) = 0.8, in units of max abs(e(alpha, t)):",
      to_markdown(table),
      fmt::format(
          "What holds exactly: the inverse of the member (alpha, beta, gamma) with step h is "
          "(1 - alpha, -beta, -gamma) with step -h; there and back with these two returns to "
          "{:.1e}. With beta, gamma of one sign in both, as in the paper, the leading term h e1 of "
          "the error changes its sign and the next, h^2 e2, does not. So a member is "
          "reversible if and only if alpha = 1/2 and beta, gamma are zero or odd in h.",
          by_adjoint),
      "Members of higher order that stand on the midpoint rule are their own adjoints too: there "
      "and "
      "back returns to " +
          orders + "."};
  section.numbers = {{"mirror_order", std::log2(coarse.opposite / fine.opposite)},
                     {"return_by_adjoint", by_adjoint},
                     {"return_half", half}};
  return section;
}

}  // namespace hamgen::paper
