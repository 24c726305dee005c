#include "generator/verify/linear_stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "generator/verify/linear_eigenvalues.hpp"
#include "generator/verify/linear_modes.hpp"
#include "generator/verify/linear_step.hpp"

namespace hamgen {

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;

constexpr Eigen::Index kMostTogether = 64;  // degrees of freedom of a matrix that has no modes
constexpr double kBorder = 1e-10;           // a margin that is not told from 0
constexpr double kFirst = 1e-3;             // h w where the search for a bound begins
constexpr double kLast = 1e3;               // and where it ends

// Below zero, or not finite, where the powers of M are unbounded.
double margin_of(const MatrixXd& m, bool symplectic) {
  if (!m.allFinite()) return -1.0;
  if (symplectic) {
    // det M = 1: the eigenvalues have modulus 1 and are two iff |trace| < 2, that is
    // det(M + I) = 2 + trace > 0 and det(M - I) = 2 - trace > 0, the latter small for a small h.
    const double diagonal = (m(0, 0) - 1.0) * (m(1, 1) - 1.0);
    const double across = m(0, 1) * m(1, 0);
    const double size = std::abs(diagonal) + std::abs(across);
    return std::min(1.0 + 0.5 * m.trace(), size > 0.0 ? (diagonal - across) / size : 0.0);
  }
  return 1.0 - spectral_radius(m);
}

// The same for more degrees of freedom.  The eigenvalues lambda of a symplectic M are unimodular
// and semisimple if all lambda + 1/lambda, eigenvalues of M + M^-1 that are there twice, are real
// and between -2 and 2.  Free motions have 2.
double margin_together(const MatrixXd& m, int free_motions) {
  if (!m.allFinite()) return -1.0;
  const MatrixXd sum = m + m.inverse();
  if (!sum.allFinite()) return -1.0;
  std::vector<double> margins;
  for (const std::complex<double>& twice : eigenvalues(sum)) {
    const double across = std::abs(twice.imag());
    margins.push_back(across > 1e-6 * (1.0 + std::abs(twice)) ? -across
                                                              : 1.0 - std::abs(twice.real()) / 2.0);
  }
  std::ranges::sort(margins, {}, [](double x) { return std::abs(x); });
  const auto skipped = static_cast<std::ptrdiff_t>(2 * free_motions);
  return *std::min_element(margins.begin() + skipped, margins.end());
}

// The smallest h in [low, high] where the function is below zero; empty if none was found.  Between
// the points of a grid it looks at minima, so that a narrow gap is not stepped over.
std::optional<double> first_below_zero(const std::function<double(double)>& function, double low,
                                       double high, double ratio) {
  const auto crossing = [&](double good, double bad) {
    for (int halving = 0; halving < 60 && bad - good > 1e-14 * bad; ++halving) {
      const double middle = 0.5 * (good + bad);
      (function(middle) < 0.0 ? bad : good) = middle;
    }
    return bad;
  };
  double before = low;
  double here = low;
  double value_before = function(low);
  double value_here = value_before;
  if (value_here < -kBorder) return low;
  for (double next = low * ratio; next <= high; next *= ratio) {
    const double value = function(next);
    if (value_here < 0.1 && value_here < value_before && value_here < value) {
      double left = before;
      double right = next;
      constexpr double golden = 0.618033988749895;
      for (int i = 0; i < 40; ++i) {
        const double a = right - golden * (right - left);
        const double b = left + golden * (right - left);
        (function(a) < function(b) ? right : left) = function(a) < function(b) ? b : a;
      }
      const double lowest = 0.5 * (left + right);
      if (function(lowest) < -kBorder) return crossing(before, lowest);
    }
    if (value < -kBorder) return crossing(here, next);
    before = here;
    value_before = value_here;
    here = next;
    value_here = value;
  }
  return std::nullopt;
}

bool is_oscillation(const Matrix2d& s, double smallest) {
  return s.determinant() > 0.25 * smallest * smallest;
}

// C = 0: M is a function of A, and lambda = i y becomes a quotient of conjugate numbers.
bool is_cayley(const Scheme& scheme) { return scheme.has_member() && scheme.member().c.empty(); }

std::string cayley_text(const Scheme& scheme) {
  if (const auto* composition = std::get_if<Composition>(&scheme.method))
    return fmt::format("a product of {} Cayley transforms of A = J S",
                       composition->substeps.size());
  const int order = scheme.member().generating_order;
  if (order > 2) return fmt::format("the Cayley transform of 2 tanh(hA/2) to order {}", order);
  return "the Cayley transform (1 - hA/2)^-1 (1 + hA/2) of A = J S, and theta = 2 atan(h w/2)";
}

// The modes of a linear part, each a plane of its own.
class Modes {
 public:
  Modes(std::vector<Matrix2d> planes, const LinearStep& step)
      : planes_(std::move(planes)), step_(step), symplectic_(step.scheme().symplectic) {
    std::ranges::sort(planes_, {}, [](const Matrix2d& s) { return s.determinant(); });
  }

  // Equal planes once; without beta and gamma the bound is one for h w, and the fastest meets it
  // first.
  [[nodiscard]] double margin(double h) const {
    double smallest = 1.0;
    const bool one = scales();
    for (std::size_t k = one ? planes_.size() - 1 : 0; k < planes_.size(); ++k) {
      if (k > 0 && !one && planes_[k].isApprox(planes_[k - 1], 1e-12)) continue;
      smallest = std::min(smallest, margin_of(step_.matrix(h, planes_[k]), symplectic_));
    }
    return smallest;
  }
  // The mode that is unbounded, or else the fastest.
  [[nodiscard]] std::size_t critical(double h) const {
    std::vector<double> margins;
    for (const Matrix2d& s : planes_) margins.push_back(margin_of(step_.matrix(h, s), symplectic_));
    const auto smallest = std::ranges::min_element(margins);
    if (*smallest > kBorder) return planes_.size() - 1;
    return static_cast<std::size_t>(smallest - margins.begin());
  }
  [[nodiscard]] double angle(std::size_t k, double h) const {
    // Of M without what it damps: 2 - trace = det(M - I) = 4 sin^2(theta/2) keeps its digits.
    Matrix2d m = step_.matrix(h, planes_[k]);
    m /= std::sqrt(std::abs(m.determinant()));
    const double minus = (m(0, 0) - 1.0) * (m(1, 1) - 1.0) - m(0, 1) * m(1, 0);
    const double plus = 2.0 + m.trace();
    return 2.0 * std::atan2(std::sqrt(std::max(minus, 0.0)), std::sqrt(std::max(plus, 0.0)));
  }
  [[nodiscard]] const std::vector<Matrix2d>& planes() const { return planes_; }
  [[nodiscard]] bool symplectic() const { return symplectic_; }

 private:
  [[nodiscard]] bool scales() const {
    const Scheme& scheme = step_.scheme();
    return !scheme.has_member() || (!has_beta(scheme.member()) && !has_gamma(scheme.member()) &&
                                    std::ranges::all_of(scheme.member().c, [](const auto& entry) {
                                      return !depends_on(entry.second, "h");
                                    }));
  }
  std::vector<Matrix2d> planes_;
  const LinearStep& step_;
  bool symplectic_;
};

// X and D of the mode, where the condition of linear_margin is the one.
std::string closed_form(const Scheme& scheme, const LinearStep& step, const Matrix2d& s, double h) {
  if (!scheme.is_member() || scheme.member().generating_order > 0 || s(0, 1) != 0.0) return "";
  const MatrixXd c = step.gauge(step.scheme().member(), h);
  const double alpha = 0.5 + c(0, 0);
  const double x = (1.0 - h * c(1, 0) * s(1, 1)) * (1.0 + h * s(0, 0) * c(0, 1));
  const double square = h * h * s(0, 0) * s(1, 1);
  return fmt::format("; X = {:.6g}, bounded iff X > h^2 w^2 (alpha - 1/2)^2 = {:.6g}", x,
                     square * (alpha - 0.5) * (alpha - 0.5));
}

void decide_by_modes(const Modes& modes, const LinearStep& step, LinearStability& result) {
  const double fastest = result.frequencies.back();
  const std::size_t critical = modes.critical(result.h);
  const Matrix2d& s = modes.planes()[critical];
  const double w = std::sqrt(s.determinant());
  const MatrixXd m = step.matrix(result.h, s);
  if (!m.allFinite()) {
    result.detail = fmt::format("the step has no finite matrix for w = {:.6g}", w);
    return;
  }
  const double margin = margin_of(m, modes.symplectic());
  result.margin = margin;
  result.largest_h = first_below_zero([&](double h) { return modes.margin(h); }, kFirst / fastest,
                                      kLast / fastest, 1.01);
  const std::string what = modes.symplectic() ? "|trace M|/2" : "spectral radius of M";
  const std::string value =
      fmt::format("{} = {:.8g} of w = {:.6g}", what,
                  modes.symplectic() ? std::abs(m.trace()) / 2.0 : 1.0 - margin, w) +
      closed_form(step.scheme(), step, s, result.h);
  // Without det M = 1 an eigenvalue of modulus 1 is no border.
  const double border = modes.symplectic() ? kBorder : -kBorder;
  if (margin > border) {
    result.verdict = Verdict::tested;
    result.detail = (modes.symplectic() ? "bounded: " : "damped: ") + value;
  } else if (margin < -kBorder) {
    result.verdict = Verdict::refuted;
    result.detail = "unbounded: " + value;
  } else {
    result.detail = "on the border: " + value;
  }
}

void decide_together(const MatrixXd& s, const LinearStep& step, LinearStability& result) {
  const auto margin = [&](double h) {
    return margin_together(step.matrix(h, s), result.free_motions);
  };
  const double fastest = result.frequencies.back();
  result.margin = margin(result.h);
  result.largest_h = first_below_zero(margin, 10 * kFirst / fastest, kLast / 10 / fastest, 1.05);
  const std::string what = fmt::format("the eigenvalues of M + M^-1, {} x {},", s.rows(), s.cols());
  if (*result.margin > kBorder) {
    result.verdict = Verdict::tested;
    result.detail = fmt::format("bounded: {} are real and at most {:.6g} in size", what,
                                2.0 * (1.0 - *result.margin));
  } else if (*result.margin < -kBorder) {
    result.verdict = Verdict::refuted;
    result.detail = fmt::format("unbounded: {} are not all real and between -2 and 2", what);
  } else {
    result.detail = fmt::format("on the border: of {} one is -2, 2 or double", what);
  }
}

// theta of every mode, and where the fastest resonates before it becomes unbounded.
void find_resonances(const Modes& modes, LinearStability& result) {
  for (std::size_t k = 0; k < modes.planes().size(); ++k)
    result.angles.push_back(modes.angle(k, result.h));
  const double fastest = result.frequencies.back();
  const double last = std::min(result.largest_h.value_or(10.0 / fastest), 10.0 / fastest);
  for (const int m : {3, 4, 5, 6}) {
    const double goal = 2.0 * std::numbers::pi / m;
    const auto missing = [&](double h) { return goal - modes.angle(modes.planes().size() - 1, h); };
    const auto h = first_below_zero(missing, kFirst / fastest, last, 1.02);
    if (h) result.resonant_h.emplace(m, *h);
  }
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
                                 const std::map<std::string, Precise>& values, double h) {
  const Eigen::Index size = 2 * part.degrees_of_freedom;
  const MatrixXd s = Eigen::Map<const MatrixXd>(part.hessian.data(), size, size);
  const LinearSpectrum spectrum = linear_spectrum(s);
  LinearStability result{.h = h,
                         .frequencies = spectrum.frequencies,
                         .free_motions = spectrum.free_motions,
                         .growing = spectrum.growing,
                         .growth_rate = spectrum.growth_rate};
  const LinearStep step(scheme, values);
  const std::optional<Scheme> one = scheme_of_one(scheme);
  const LinearStep step_of_one(one ? *one : scheme, values);
  find_iteration_radius(s, spectrum.largest, step, step_of_one, result);
  if (result.frequencies.empty()) {
    result.detail = "the flow has no oscillation here that a step could make unbounded";
    return result;
  }
  if (spectrum.resonant) {
    result.resonant = true;
    result.detail =
        "the flow itself grows like t: a frequency is double, with a Jordan block of A = J S";
    return result;
  }
  if (scheme.has_member() && !scheme.symplectic) {
    result.detail = "C is outside sp(2n): the conditions are those of symplectic members";
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
  if (is_cayley(scheme)) {
    result.verdict = Verdict::proved;
    result.bounded_for_every_h = true;
    result.detail = "M is " + cayley_text(scheme);
  } else if (tableau != nullptr && scheme.symplectic) {
    // R(x) R(-x) = 1, and Gauss methods are A-stable (HLW II.1.3, IV.1): no pole at x = i y.
    result.verdict = Verdict::proved;
    result.bounded_for_every_h = true;
    result.detail = "|R(iy)| = 1 for the stability function R of Gauss collocation, for every y";
  } else if (modes) {
    decide_by_modes(*modes, step_of_one, result);
  } else if (result.growing > 0) {
    result.detail =
        "the flow itself grows, and no planes of its oscillations are known that the "
        "step keeps";
  } else if (part.degrees_of_freedom > kMostTogether) {
    result.detail = fmt::format(
        "{} degrees of freedom, more than {}, and no modes are known that "
        "the step keeps",
        part.degrees_of_freedom, kMostTogether);
  } else {
    decide_together(s, step, result);
  }
  if (modes && result.verdict != Verdict::refuted) find_resonances(*modes, result);
  return result;
}

}  // namespace hamgen
