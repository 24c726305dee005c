#include "generator/verify/stable_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "generator/algebra/from_ginac.hpp"
#include "generator/mechanics/mechanics.hpp"
#include "generator/verify/bounded_powers.hpp"

namespace hamgen {

namespace {

constexpr int kLongest = 160;       // degree of a polynomial in h whose roots are looked for
constexpr int kMostEvaluated = 80;  // h at which the characteristic polynomial is computed

using Coefficients = std::vector<RationalPolynomial>;  // of 1, s, s^2, ..., polynomials in h

RationalPolynomial product_of_all(const std::vector<RationalPolynomial>& factors) {
  RationalPolynomial result{Rational(1)};
  for (const RationalPolynomial& p : factors) result = product_of(result, p);
  return result;
}

RationalPolynomial sum_of_all(const std::vector<RationalPolynomial>& terms) {
  RationalPolynomial result;
  for (const RationalPolynomial& p : terms) result = sum_of(result, p);
  return result;
}

// The coefficients of det(x - M) times the denominator, from their values at h = 1, 2, ...
std::optional<Coefficients> characteristic_in_h(const RationalStep& step, const ExactMatrix& s) {
  const std::optional<int> most = step.degree_in_h(s.size);
  if (!most || *most > kMostEvaluated) return std::nullopt;
  const auto count = static_cast<std::size_t>(*most) + 1;
  std::vector<std::vector<std::pair<Rational, Rational>>> values(s.size + 1);
  for (long h = 1; values[0].size() < count; ++h) {
    const Rational denominator = step.denominator(Rational(h), s);
    if (denominator == 0) continue;
    const ExactMatrix m = step.matrix(Rational(h), s);
    if (m.size == 0) return std::nullopt;
    const RationalPolynomial p = characteristic_polynomial(m);
    for (std::size_t k = 0; k <= s.size; ++k)
      values[k].emplace_back(Rational(h), p[k] * denominator);
  }
  Coefficients result;
  for (const auto& points : values) result.push_back(interpolated(points));
  return result;
}

// q of the palindromic polynomial, without the factors s - 2 of the free motions.
Coefficients in_s(const Coefficients& p, int free_motions) {
  const std::size_t n = p.size() / 2;
  const std::vector<RationalPolynomial> powers = symmetric_powers(n);
  Coefficients q(n + 1);
  for (std::size_t k = 0; k <= n; ++k) {
    const RationalPolynomial c = scaled_by(Rational(1, 2), sum_of(p[n + k], p[n - k]));
    for (std::size_t j = 0; j < powers[k].size(); ++j)
      q[j] = sum_of(q[j], scaled_by(powers[k][j], c));
  }
  for (int k = 0; k < free_motions && q.size() > 1; ++k) {
    Coefficients quotient(q.size() - 1);
    RationalPolynomial carried;
    for (std::size_t j = q.size(); j-- > 1;) {
      carried = sum_of(q[j], scaled_by(Rational(2), carried));
      quotient[j - 1] = carried;
    }
    q = std::move(quotient);
  }
  return q;
}

RationalPolynomial at_s(const Coefficients& q, long s) {
  RationalPolynomial value;
  for (std::size_t k = q.size(); k-- > 0;) value = sum_of(scaled_by(Rational(s), value), q[k]);
  return value;
}

// b^2 - 4 a c, and b^2 c^2 - 4 a c^3 - 4 b^3 d - 27 a^2 d^2 + 18 a b c d.
RationalPolynomial discriminant(const Coefficients& q) {
  const auto term = [](long factor, const std::vector<RationalPolynomial>& factors) {
    return scaled_by(Rational(factor), product_of_all(factors));
  };
  if (q.size() == 3) return sum_of(term(1, {q[1], q[1]}), term(-4, {q[0], q[2]}));
  const auto& [d, c, b, a] = std::tie(q[0], q[1], q[2], q[3]);
  return sum_of_all({term(1, {b, b, c, c}), term(-4, {a, c, c, c}), term(-4, {b, b, b, d}),
                     term(-27, {a, a, d, d}), term(18, {a, b, c, d})});
}

// Each factor of q in s once: eigenvalues that are equal for every h do not collide.
Coefficients square_free_in_s(const Coefficients& q) {
  SymbolTable table;
  const GiNaC::ex s = table.symbol("s", 0);
  const GiNaC::ex h = table.symbol("h", kRankOfStep);
  GiNaC::ex sum = 0;
  for (std::size_t k = 0; k < q.size(); ++k) {
    for (std::size_t l = 0; l < q[k].size(); ++l) {
      sum += to_ginac(q[k][l]) * GiNaC::pow(s, static_cast<long>(k)) *
             GiNaC::pow(h, static_cast<long>(l));
    }
  }
  const GiNaC::ex common = GiNaC::gcd(sum, sum.diff(GiNaC::ex_to<GiNaC::symbol>(s)));
  const GiNaC::ex once = GiNaC::quo(sum, common, s).normal().numer().expand();
  Coefficients result;
  for (int k = 0; k <= once.degree(s); ++k) {
    const GiNaC::ex coefficient = once.coeff(s, k);
    RationalPolynomial& p = result.emplace_back();
    for (int l = 0; l <= coefficient.degree(h); ++l)
      p.push_back(to_rational(GiNaC::ex_to<GiNaC::numeric>(coefficient.coeff(h, l))));
    p = trimmed(std::move(p));
  }
  return result;
}

using Root = std::pair<Rational, Rational>;  // an interval with a root

Rational square_root(const Rational& x, bool upwards) {
  // From a double, which is moved by a few of its units.
  const double root = std::sqrt(to_double(x));
  return from_double(root * (upwards ? 1.0 + 1e-15 : 1.0 - 1e-15));
}

// A polynomial in h^2 is half as long.
void add_positive_roots(RationalPolynomial p, std::vector<Root>& roots) {
  while (!p.empty() && p.front() == 0) p.erase(p.begin());
  if (degree(p) < 1) return;
  bool even = true;
  for (std::size_t k = 1; k < p.size(); k += 2) even = even && p[k] == 0;
  if (even) {
    RationalPolynomial half;
    for (std::size_t k = 0; k < p.size(); k += 2) half.push_back(p[k]);
    p = std::move(half);
  }
  for (auto [low, high] : positive_roots(p)) {
    if (even) {
      low = square_root(low, false);
      high = square_root(high, true);
    }
    roots.emplace_back(low, high);
  }
}

// Those that overlap become one.
std::vector<Root> apart(std::vector<Root> roots) {
  std::ranges::sort(roots);
  std::vector<Root> result;
  for (const Root& root : roots) {
    if (!result.empty() && root.first <= result.back().second) {
      result.back().second = std::max(result.back().second, root.second);
    } else {
      result.push_back(root);
    }
  }
  return result;
}

// The cells between the roots, each decided at one of its points.
template <class IsBounded>
std::optional<StableSteps> joined(const std::vector<RationalPolynomial>& critical,
                                  const IsBounded& is_bounded) {
  std::vector<Root> roots;
  for (const RationalPolynomial& p : critical) {
    if (degree(p) > kLongest) return std::nullopt;
    add_positive_roots(p, roots);
  }
  roots = apart(std::move(roots));
  StableSteps steps;
  double from = 0.0;
  bool before = false;
  for (std::size_t cell = 0; cell <= roots.size(); ++cell) {
    const Rational low = cell == 0 ? Rational(0) : roots[cell - 1].second;
    const Rational high = cell == roots.size() ? Rational(2 * low + 1) : roots[cell].first;
    const std::optional<bool> bounded = is_bounded(simple_between(low, high));
    if (!bounded) return std::nullopt;
    if (*bounded && before) {
      steps.borders.push_back(from);
      steps.intervals.back().second = std::numeric_limits<double>::infinity();
    } else if (*bounded) {
      steps.intervals.emplace_back(from, std::numeric_limits<double>::infinity());
    }
    if (cell < roots.size()) {
      from = to_double(Rational((roots[cell].first + roots[cell].second) / 2));
      if (*bounded) steps.intervals.back().second = from;
    }
    before = *bounded;
  }
  return steps;
}

}  // namespace

bool StableSteps::is_every_h() const {
  return intervals.size() == 1 && intervals[0].first == 0.0 && std::isinf(intervals[0].second);
}

std::optional<double> StableSteps::first_end() const {
  if (intervals.empty() || intervals[0].first > 0.0 || intervals[0].second >= looked_to)
    return std::nullopt;
  return intervals[0].second;
}

std::vector<std::pair<double, double>> StableSteps::gaps() const {
  std::vector<std::pair<double, double>> result;
  for (std::size_t k = 1; k < intervals.size(); ++k)
    result.emplace_back(intervals[k - 1].second, intervals[k].first);
  return result;
}

std::optional<StableSteps> stable_steps(const RationalStep& step, const ExactMatrix& s,
                                        int free_motions) {
  const auto p = characteristic_in_h(step, s);
  if (!p) return std::nullopt;
  const Coefficients all = in_s(*p, free_motions);
  Coefficients q = all;
  if (q.size() > 2 && discriminant(q).empty()) q = square_free_in_s(q);
  std::vector<RationalPolynomial> critical{q.back(), at_s(q, 2), at_s(q, -2)};
  if (q.size() > 2) critical.push_back(discriminant(q));
  return joined(critical, [&](const Rational& h) -> std::optional<bool> {
    const ExactMatrix m = step.matrix(h, s);
    if (m.size == 0) return std::nullopt;
    const Powers found = powers_of(m, free_motions, step.is_exact());
    if (found == Powers::undecided) return std::nullopt;
    return found == Powers::bounded;
  });
}

std::optional<StableSteps> damped_steps(const RationalStep& step, const ExactMatrix& s) {
  const auto p = characteristic_in_h(step, s);
  if (!p) return std::nullopt;
  // The eigenvalues are conjugate, and their product is p_0.
  const RationalPolynomial excess = sum_of(p->front(), {Rational(-1)});
  return joined({excess},
                [&](const Rational& h) -> std::optional<bool> { return value_at(excess, h) <= 0; });
}

StableSteps divided_by(StableSteps steps, double w) {
  for (auto& [from, to] : steps.intervals) {
    from /= w;
    to /= w;
  }
  for (double& border : steps.borders) border /= w;
  steps.looked_to /= w;
  return steps;
}

StableSteps intersection(const StableSteps& a, const StableSteps& b) {
  StableSteps result{.looked_to = std::min(a.looked_to, b.looked_to), .exact = a.exact && b.exact};
  for (const auto& [from_a, to_a] : a.intervals) {
    for (const auto& [from_b, to_b] : b.intervals) {
      const double from = std::max(from_a, from_b);
      const double to = std::min(to_a, to_b);
      if (from < to) result.intervals.emplace_back(from, to);
    }
  }
  std::ranges::sort(result.intervals);
  for (const std::vector<double>* borders : {&a.borders, &b.borders}) {
    for (const double h : *borders) {
      const auto inside = [h](const auto& i) { return i.first < h && h < i.second; };
      if (std::ranges::any_of(result.intervals, inside)) result.borders.push_back(h);
    }
  }
  std::ranges::sort(result.borders);
  return result;
}

}  // namespace hamgen
