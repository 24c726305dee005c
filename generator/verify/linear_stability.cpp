#include "generator/verify/linear_stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "generator/verify/bounded_powers.hpp"
#include "generator/verify/linear_angles.hpp"
#include "generator/verify/linear_eigenvalues.hpp"
#include "generator/verify/linear_enclosed_steps.hpp"
#include "generator/verify/linear_modes.hpp"
#include "generator/verify/linear_parts.hpp"
#include "generator/verify/linear_step.hpp"

namespace hamgen {

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;

constexpr Eigen::Index kMostTogether = 64;  // degrees of freedom of a matrix that has no modes
constexpr std::size_t kMostExact = 8;       // of one whose characteristic polynomial is computed
constexpr std::size_t kMostSearched = 3;    // of one whose h are searched
constexpr std::size_t kMostPlanes = 64;
constexpr double kBorder = 1e-10;  // a margin that is not told from 0
// Relative changes that a statement about rounded numbers must survive.
const char* const kDigitsOfValues = "1e-30";
const char* const kDigitsOfModes = "1e-12";

bool is_oscillation(const Matrix2d& s, double smallest) {
  return s.determinant() > 0.25 * smallest * smallest;
}

// C = 0: M is a function of A, and lambda = i y becomes a quotient of conjugate numbers.
bool is_cayley(const Scheme& scheme) { return scheme.has_member() && scheme.member().c.empty(); }

std::string cayley_text(const Scheme& scheme) {
  if (const auto* composition = std::get_if<Composition>(&scheme.method))
    return fmt::format("a product of {} Cayley transforms of `A = J S`",
                       composition->substeps.size());
  const int order = scheme.member().generating_order;
  if (order > 2) return fmt::format("the Cayley transform of `2 tanh(hA/2)` to order {}", order);
  return "the Cayley transform `(1 - hA/2)^-1 (1 + hA/2)` of `A = J S`, and `theta = 2 atan(h "
         "omega/2)`";
}

// Is M a function of h A alone, in the coordinates of the modes?
bool scales(const Scheme& scheme) {
  return !scheme.has_member() || (!has_beta(scheme.member()) && !has_gamma(scheme.member()) &&
                                  std::ranges::all_of(scheme.member().c, [](const auto& entry) {
                                    return !depends_on(entry.second, "h");
                                  }));
}

// X and D of the mode, where the condition of linear_margin is the one.
std::string closed_form(const Scheme& scheme, const LinearStep& step, const Matrix2d& s, double h) {
  if (!scheme.is_member() || scheme.member().generating_order > 0 || s(0, 1) != 0.0) return "";
  const MatrixXd c = step.gauge(step.scheme().member(), h);
  const double alpha = 0.5 + c(0, 0);
  const double x = (1.0 - h * c(1, 0) * s(1, 1)) * (1.0 + h * s(0, 0) * c(0, 1));
  const double square = h * h * s(0, 0) * s(1, 1);
  return fmt::format("; `X = {:.6g}`, bounded iff `X > h^2 omega^2 (alpha - 1/2)^2 = {:.6g}`", x,
                     square * (alpha - 0.5) * (alpha - 0.5));
}

ExactMatrix rational(const Matrix2d& s) {
  return {2,
          {from_double(s(0, 0)), from_double(s(0, 1)), from_double(s(1, 0)), from_double(s(1, 1))}};
}

// What is asked of one linear part.
struct Question {
  const Scheme& scheme;
  const Scheme& scheme_of_one;
  const std::map<std::string, Rational>& values;
  ExactMatrix s;
  bool exact = false;  // S is no rounded number
  Rational h;
};

void keep(const std::optional<StableSteps>& more, std::optional<StableSteps>& all) {
  all = more && all ? std::optional(intersection(*all, *more)) : std::nullopt;
}

StableSteps every_h() { return {.intervals = {{0.0, std::numeric_limits<double>::infinity()}}}; }

// In rationals if that is possible, else by intervals of h.
std::optional<StableSteps> steps_of_part(const Scheme& scheme,
                                         const std::map<std::string, Rational>& values,
                                         const ExactMatrix& s, const LinearSpectrum& spectrum) {
  if (auto found = stable_steps(RationalStep(scheme, values), s, spectrum.free_motions))
    return found;
  if (spectrum.growing > 0) return std::nullopt;
  return enclosed_steps(scheme, values, s, spectrum.free_motions, spectrum.frequencies.back());
}

// One stability function over the frequencies, or one for each plane.
std::optional<StableSteps> steps_of_modes(const Question& question, const Modes& modes) {
  const RationalStep step(question.scheme_of_one, question.values);
  const ExactMatrix unit = ExactMatrix::identity(2);
  const bool one = scales(question.scheme);
  std::optional<StableSteps> in_y;
  if (!question.scheme.symplectic) in_y = damped_steps(step, unit);
  if (question.scheme.symplectic && one) in_y = stable_steps(step, unit, 0);
  std::optional<StableSteps> all = every_h();
  std::size_t different = 0;
  for (std::size_t k = 0; k < modes.planes().size(); ++k) {
    if (k > 0 && modes.planes()[k].isApprox(modes.planes()[k - 1], 1e-12)) continue;
    if (!one && ++different > kMostPlanes) return std::nullopt;
    if (one && !in_y) return std::nullopt;
    const ExactMatrix plane = rational(modes.planes()[k]);
    keep(one ? std::optional(divided_by(*in_y, modes.frequency(k)))
             : steps_of_part(question.scheme_of_one, question.values, plane, exact_spectrum(plane)),
         all);
  }
  if (all && !one) all->exact = false;
  return all;
}

std::optional<StableSteps> steps_of_parts(const Question& question,
                                          const std::vector<LinearPart>& parts) {
  std::optional<StableSteps> all = every_h();
  for (const LinearPart& part : parts) {
    const std::size_t n = part.s.size / 2;
    if (n > kMostSearched) return std::nullopt;
    const LinearSpectrum spectrum = exact_spectrum(part.s);
    if (spectrum.free_motions == static_cast<int>(n)) continue;
    keep(steps_of_part(part.scheme, question.values, part.s, spectrum), all);
  }
  return all;
}

std::string mode_text(const Question& question, const LinearStep& step, const Modes& modes,
                      std::size_t k) {
  const double h = to_double(question.h);
  const Matrix2d m = modes.matrix(k, h);
  const bool symplectic = question.scheme.symplectic;
  const std::string size =
      symplectic ? fmt::format("`|trace M|/2 = {:.8g}`", std::abs(m.trace()) / 2.0)
                 : fmt::format("spectral radius of `M` = {:.8g}", std::sqrt(m.determinant()));
  return fmt::format("{} of `omega = {:.6g}`", size, modes.frequency(k)) +
         closed_form(step.scheme(), step, modes.planes()[k], h);
}

void set_verdict(Powers powers, bool exact, LinearStability& result) {
  switch (powers) {
    case Powers::bounded:
      result.verdict = exact ? Verdict::proved : Verdict::tested;
      break;
    case Powers::growing:
    case Powers::resonant:
      result.verdict = Verdict::refuted;
      break;
    case Powers::undecided:
      result.verdict = Verdict::not_decided;
  }
}

void decide_by_modes(const Question& question, const LinearStep& step, const Modes& modes,
                     LinearStability& result) {
  const RationalStep exact_step(question.scheme_of_one, question.values);
  const bool one = modes.planes().size() == 1 && question.s.size == 2;
  const bool exact = one && question.exact && exact_step.is_exact();
  const bool symplectic = question.scheme.symplectic;
  std::size_t critical = modes.planes().size() - 1;
  Powers all = Powers::bounded;
  for (std::size_t k = 0; k < modes.planes().size(); ++k) {
    const ExactMatrix plane = one ? question.s : rational(modes.planes()[k]);
    Powers now = Powers::undecided;
    if (symplectic) {
      now = powers_at(exact_step, question.h, plane, 0, exact, kDigitsOfModes);
    } else {
      // The eigenvalues are conjugate.  One of modulus 1 is no border: what is damped is bounded.
      const Rational excess = determinant(exact_step.matrix(question.h, plane)) - 1;
      now = excess > 0 ? Powers::growing : Powers::bounded;
      if (!exact && std::abs(to_double(excess)) < 1e-12) now = Powers::undecided;
    }
    if (now == Powers::bounded) continue;
    if (all == Powers::bounded || all == Powers::undecided) {
      critical = k;
      all = now;
    }
  }
  const Matrix2d m = modes.matrix(critical, result.h);
  result.margin = margin_of(m, symplectic);
  set_verdict(all, exact, result);
  const char* words = all == Powers::growing     ? "unbounded: "
                      : all == Powers::resonant  ? "unbounded, by a Jordan block: "
                      : all == Powers::undecided ? "on the border: "
                      : symplectic               ? "bounded: "
                                                 : "damped: ";
  result.detail = words + mode_text(question, step, modes, critical);
}

void decide_exactly(const Question& question, const std::vector<LinearPart>& parts,
                    LinearStability& result) {
  bool exact = question.exact;
  Powers all = Powers::bounded;
  for (const LinearPart& part : parts) {
    const RationalStep step(part.scheme, question.values);
    const LinearSpectrum spectrum = exact_spectrum(part.s);
    const bool exact_part = question.exact && step.is_exact();
    exact = exact && exact_part;
    if (spectrum.free_motions * 2 == static_cast<int>(part.s.size)) continue;
    const Powers now =
        powers_at(step, question.h, part.s, spectrum.free_motions, exact_part, kDigitsOfValues);
    if (now != Powers::bounded && (all == Powers::bounded || all == Powers::undecided)) all = now;
  }
  set_verdict(all, exact, result);
  const std::string what = fmt::format("of `M`, {0} x {0},", question.s.size);
  switch (all) {
    case Powers::bounded:
      result.detail = fmt::format(
          "bounded: the eigenvalues {} have modulus 1 and as many eigenvectors, by Sturm sequences "
          "and ranks",
          what);
      break;
    case Powers::growing:
      result.detail = fmt::format("unbounded: an eigenvalue {} has another modulus than 1", what);
      break;
    case Powers::resonant:
      result.detail = fmt::format("unbounded: a multiple eigenvalue {} has a Jordan block", what);
      break;
    case Powers::undecided:
      result.detail = fmt::format(
          "on the border: an eigenvalue {} is -1, 1 or multiple, as far as "
          "its digits show",
          what);
  }
}

void decide_together(const MatrixXd& s, const LinearStep& step, LinearStability& result) {
  result.margin = margin_together(step.matrix(result.h, s), result.free_motions);
  const std::string what =
      fmt::format("the eigenvalues of `M + M^-1`, {} x {},", s.rows(), s.cols());
  if (*result.margin > kBorder) {
    result.verdict = Verdict::tested;
    result.detail = fmt::format("bounded: {} are real, apart and at most {:.6g} in size", what,
                                2.0 * (1.0 - *result.margin));
  } else if (*result.margin < -kBorder) {
    result.verdict = Verdict::refuted;
    result.detail = fmt::format("unbounded: {} are not all real and between -2 and 2", what);
  } else {
    result.detail = fmt::format("on the border: of {} one is -2, 2 or double", what);
  }
}

void keep_steps(const std::optional<StableSteps>& steps, LinearStability& result) {
  if (!steps) return;
  result.searched = true;
  // The line says both: bounded here, and up to where.
  if (!steps->exact) result.verdict = resting_on(Verdict::tested, result.verdict);
  // What is unbounded carries no bound.
  if (result.verdict == Verdict::refuted) return;
  result.bounded_for_every_h = steps->is_every_h();
  result.largest_h = steps->first_end();
  result.bounded_steps = steps->intervals;
  result.borders = steps->borders;
  result.looked_to = steps->looked_to;
}

// Of a tableau and of C = 0 the iteration is linear in A, and its spectral radius that of an
// oscillator with the largest eigenvalue of A.
void find_iteration_radius(const MatrixXd& s, double largest, const LinearStep& step,
                           const LinearStep& step_of_one, LinearStability& result) {
  const Scheme& scheme = step.scheme();
  const bool linear =
      !scheme.has_member() || (is_cayley(scheme) && scheme.member().generating_order <= 2);
  if (!linear && s.rows() > 2 * kMostTogether) return;
  const MatrixXd oscillator = Eigen::Vector2d(largest * largest, 1.0).asDiagonal();
  const MatrixXd matrix =
      linear ? step_of_one.iteration(result.h, oscillator) : step.iteration(result.h, s);
  if (matrix.size() == 0 || !matrix.allFinite()) return;
  const double radius = spectral_radius(matrix);
  // A nilpotent matrix has eigenvalues of about the root of the rounding unit.
  if (radius > 1e-6 * matrix.norm()) result.iteration_radius = radius;
}

}  // namespace

double linear_margin(double h, double omega_squared, double alpha, double beta, double gamma) {
  const double x = (1.0 + h * beta) * (1.0 - h * omega_squared * gamma);
  const double square = h * h * omega_squared;
  const double d = x + square * alpha * (1.0 - alpha);
  return std::min(d, x - square * (alpha - 0.5) * (alpha - 0.5));
}

LinearStability linear_stability(const QuadraticPart& part, const Scheme& scheme,
                                 const std::map<std::string, Rational>& values,
                                 const Rational& step_size) {
  const Eigen::Index size = 2 * part.degrees_of_freedom;
  MatrixXd s(size, size);
  for (Eigen::Index k = 0; k < size * size; ++k)
    s(k / size, k % size) = to_double(part.hessian[static_cast<std::size_t>(k)]);
  const ExactMatrix rational_s{static_cast<std::size_t>(size), part.hessian};
  const bool exact = part.exact && rational_s.size <= 2 * kMostExact;
  const LinearSpectrum spectrum = exact ? exact_spectrum(rational_s) : linear_spectrum(s);
  LinearStability result{.h = to_double(step_size),
                         .frequencies = spectrum.frequencies,
                         .free_motions = spectrum.free_motions,
                         .growing = spectrum.growing,
                         .growth_rate = spectrum.growth_rate};
  std::map<std::string, Precise> precise_values;
  for (const auto& [name, value] : values) precise_values.emplace(name, precise(value));
  const LinearStep step(scheme, precise_values);
  const std::optional<Scheme> one = scheme_of_one(scheme);
  const LinearStep step_of_one(one ? *one : scheme, precise_values);
  find_iteration_radius(s, spectrum.largest, step, step_of_one, result);
  if (result.frequencies.empty()) {
    result.detail = "the flow has no oscillation here that a step could make unbounded";
    return result;
  }
  if (spectrum.resonant) {
    result.resonant = true;
    result.detail =
        "the flow itself grows like t: a frequency is double, with a Jordan block of `A = J S`";
    return result;
  }
  if (scheme.has_member() && !scheme.symplectic) {
    result.detail = "`C` is outside `sp(2n)`: the conditions are those of symplectic members";
    return result;
  }
  std::optional<Modes> modes;
  if (is_cayley(scheme)) {
    std::vector<Matrix2d> planes;
    for (const double w : result.frequencies)
      planes.push_back(Eigen::Vector2d(w * w, 1).asDiagonal());
    modes.emplace(std::move(planes), step_of_one);
  } else if (auto planes = linear_modes(s, scheme)) {
    const double slowest = result.frequencies.front();
    std::erase_if(*planes, [&](const Matrix2d& m) { return !is_oscillation(m, slowest); });
    if (planes->size() == result.frequencies.size()) modes.emplace(std::move(*planes), step_of_one);
  }
  const auto* tableau = std::get_if<RungeKutta>(&scheme.method);
  const Question question{scheme, one ? *one : scheme, values, rational_s, exact, step_size};
  const bool is_function_of_flow = is_cayley(scheme) || (tableau != nullptr && scheme.symplectic);
  if (is_function_of_flow) {
    // Of exactly known oscillations; rounding may take slow growth for one.
    result.verdict = exact ? Verdict::proved : Verdict::tested;
    result.bounded_for_every_h = true;
    // R(x) R(-x) = 1, and Gauss methods are A-stable (HLW II.1.3, IV.1): no pole at x = i y.
    result.detail =
        is_cayley(scheme)
            ? "`M` is " + cayley_text(scheme)
            : "`|R(iy)| = 1` for the stability function `R` of Gauss collocation, for every `y`";
  } else if (modes && (tableau != nullptr || size == 2 || result.growing > 0 || !exact ||
                       rational_s.size > 2 * kMostExact)) {
    decide_by_modes(question, step_of_one, *modes, result);
    keep_steps(size == 2 && tableau == nullptr ? steps_of_part(scheme, values, rational_s, spectrum)
                                               : steps_of_modes(question, *modes),
               result);
  } else if (result.growing > 0) {
    result.detail =
        "the flow itself grows, and no planes of its oscillations are known that the "
        "step keeps";
  } else if (rational_s.size <= 2 * kMostExact) {
    const std::vector<LinearPart> parts = parts_of(scheme, rational_s);
    decide_exactly(question, parts, result);
    result.margin = margin_together(step.matrix(result.h, s), result.free_motions);
    const bool by_modes = modes && (scales(scheme) || parts.front().s.size > 2 * kMostSearched);
    keep_steps(by_modes ? steps_of_modes(question, *modes) : steps_of_parts(question, parts),
               result);
  } else if (part.degrees_of_freedom > kMostTogether) {
    result.detail = fmt::format(
        "{} degrees of freedom, more than {}, and no modes are known that "
        "the step keeps",
        part.degrees_of_freedom, kMostTogether);
  } else {
    decide_together(s, step, result);
  }
  if (modes && result.verdict != Verdict::refuted) {
    for (std::size_t k = 0; k < modes->planes().size(); ++k)
      result.angles.push_back(modes->angle(k, result.h));
    const double last = 10.0 / result.frequencies.back();
    result.resonant_h = modes->resonant_steps(std::min(result.largest_h.value_or(last), last));
  }
  return result;
}

}  // namespace hamgen
