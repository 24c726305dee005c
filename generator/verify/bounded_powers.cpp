#include "generator/verify/bounded_powers.hpp"

#include <algorithm>

namespace hamgen {

namespace {

// f*(x) = x^d f(x + 1/x).
RationalPolynomial unfolded(const RationalPolynomial& f) {
  RationalPolynomial result;
  RationalPolynomial power{Rational(1)};  // (x^2 + 1)^k
  const int d = degree(f);
  for (int k = 0; k <= d; ++k) {
    RationalPolynomial term = power;
    term.insert(term.begin(), static_cast<std::size_t>(d - k), Rational(0));
    result = sum_of(result, scaled_by(f[static_cast<std::size_t>(k)], std::move(term)));
    power = product_of(power, {Rational(1), Rational(0), Rational(1)});
  }
  return result;
}

std::size_t nullity(const ExactMatrix& a) { return a.size - rank(a); }

bool has_eigenvectors(const ExactMatrix& m, const RationalPolynomial& factor, int multiplicity) {
  const auto expected = static_cast<std::size_t>(2 * multiplicity * degree(factor));
  return nullity(value_at(unfolded(factor), m)) == expected;
}

}  // namespace

std::vector<RationalPolynomial> symmetric_powers(std::size_t n) {
  std::vector<RationalPolynomial> result{{Rational(1)}, {Rational(0), Rational(1)}};
  for (std::size_t k = 2; k <= n; ++k) {
    // D_k = s D_(k-1) - D_(k-2), where D_0 counts twice.
    const RationalPolynomial next = product_of({Rational(0), Rational(1)}, result[k - 1]);
    result.push_back(sum_of(next, scaled_by(Rational(k == 2 ? -2 : -1), result[k - 2])));
  }
  return result;
}

Powers powers_of(const ExactMatrix& m, int free_motions, bool exact) {
  const std::size_t n = m.size / 2;
  const RationalPolynomial p = characteristic_polynomial(m);
  const std::vector<RationalPolynomial> powers = symmetric_powers(n);
  RationalPolynomial q;
  for (std::size_t k = 0; k <= n; ++k) {
    if (exact && p[n + k] != p[n - k]) return Powers::undecided;
    q = sum_of(q, scaled_by((p[n + k] + p[n - k]) / 2, powers[k]));
  }
  const RationalPolynomial at_one{Rational(-2), Rational(1)};
  for (int k = 0; k < free_motions; ++k) {
    auto [quotient, rest] = divided(q, at_one);
    if (exact && !rest.empty()) return Powers::undecided;
    q = std::move(quotient);
  }
  Powers found = Powers::bounded;
  for (const auto& [factor, multiplicity] : square_free_factors(q)) {
    int inside = count_roots(factor, Rational(-2), Rational(2));
    const bool at_border =
        value_at(factor, Rational(2)) == 0 || value_at(factor, Rational(-2)) == 0;
    for (const long end : {-2L, 2L}) inside += value_at(factor, Rational(end)) == 0 ? 1 : 0;
    if (inside < degree(factor)) return Powers::growing;
    // The free motions' eigenvalue: which eigenvectors are whose is not known.
    if (free_motions > 0 && value_at(factor, Rational(2)) == 0) {
      found = Powers::undecided;
      continue;
    }
    if (multiplicity == 1 && !at_border) continue;
    if (multiplicity > 1 && !has_eigenvectors(m, factor, multiplicity)) found = Powers::resonant;
    for (const long end : {-2L, 2L}) {
      // x = +-1 is there twice for every root s = +-2.
      if (value_at(factor, Rational(end)) != 0) continue;
      const RationalPolynomial linear{Rational(-end / 2), Rational(1)};
      if (nullity(value_at(linear, m)) < static_cast<std::size_t>(2 * multiplicity))
        found = Powers::resonant;
    }
  }
  return found;
}

}  // namespace hamgen
